// A server of one folder for tests, on this machine alone.
import { createServer } from 'node:http';
import { readFileSync } from 'node:fs';
import { extname, join } from 'node:path';

const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm', '.wgsl': 'text/plain' };

/// Serves the folder; `close` of the result ends it, and `address` is that of its page.
export async function serve(folder) {
  const server = createServer(({ url }, answer) => {
    const path = join(folder, url.split(/[?#]/)[0].replace(/\/$/, '/index.html'));
    try {
      const body = readFileSync(path);
      answer.writeHead(200, { 'content-type': TYPES[extname(path)] ?? 'application/octet-stream' });
      answer.end(body);
    } catch {
      answer.writeHead(404);
      answer.end();
    }
  });
  await new Promise(ready => server.listen(0, '127.0.0.1', ready));
  return { address: `http://127.0.0.1:${server.address().port}/`, close: () => server.close() };
}

// Runs the program in node: writes its output, and exits with its code.
import { readFileSync, writeSync } from 'node:fs';
let memory;
const host = { host_write: (text, length) => writeSync(1, new Uint8Array(memory.buffer, text, length)) };
const { instance } = await WebAssembly.instantiate(readFileSync(process.argv[2]), { host });
memory = instance.exports.memory;
process.exit(instance.exports.run());

/// What a generated source declares: the function of a hit with the given ending, and the struct of constants with its fields in order.
export function hitFunction(source, ending = '_hit\\w*') {
  const [, call, type] = source.match(new RegExp(`fn (hairis_\\w+${ending})\\(material: (\\w+)`)),
    [, body] = source.match(new RegExp(`struct ${type} \\{([^}]*)\\}`));
  // A field is a number, or an array of numbers.
  const places = Array.from(body.matchAll(/(\w+): (?:array<f32, (\d+)>|f32)/g), ([, name, size]) =>
    size ? Array.from({ length: +size }, (_, i) => `${name}[${i}]`) : [name],
  ).flat();
  return { call, type, places };
}

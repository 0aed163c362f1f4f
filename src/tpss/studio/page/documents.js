// Documents and the schema that describes them.

/** What stands at a key path of numbers and keys; undefined if nothing does. */
export function at(document, path) {
  let found = document;
  for (const key of path ? path.split(".") : []) {
    if (found === null || typeof found !== "object") return undefined;
    found = found[key];
  }
  return found;
}

const typeOf = value =>
  Array.isArray(value) ? "array" : value === null ? "null" : typeof value;

export class Schema {
  constructor(root, labels) {
    this.root = root;
    this.labels = labels;
  }

  /** Words and unit of a key. */
  label(key) { return this.labels[key] || [key.replaceAll("_", " "), ""]; }

  resolved(schema) {
    let found = schema;
    while (found && found.$ref) {
      const { $ref, ...own } = found;
      found = { ...this.root.$defs[$ref.split("/").at(-1)], ...own };
    }
    return found || {};
  }

  /** Alternatives that a value may be, each resolved. */
  alternatives(schema) {
    const whole = this.resolved(schema);
    const choices = whole.anyOf || whole.oneOf;
    if (!choices || whole.properties) return [whole];
    return choices.flatMap(each => this.alternatives(each));
  }

  /** The alternative that fits a value, with the description of the whole. */
  of(schema, value) {
    const description = this.resolved(schema).description;
    const all = this.alternatives(schema);
    const kind = typeOf(value);
    const fits = all.filter(each => kind === "number" ? ["number", "integer"].includes(each.type)
      : each.type === kind || (each.enum && each.enum.includes(value)) || (each.const !== undefined && kind === "string"));
    const found = fits[0] || all[0];
    const names = all.flatMap(each => each.enum || (each.const !== undefined ? [each.const] : []));
    const open = all.some(each => each.type === "string" && !each.enum && each.const === undefined);
    return { ...found, description, names, open };
  }
}

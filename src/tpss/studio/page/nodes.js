// What a form consists of: nodes made from the schema, the document and what the scenario comes to.

const SCALARS = ["number", "text", "choice", "flag"];
const MOST_COLUMNS = 4;
const ROWS_OF_A_TABLE = 8;

export const isScalar = node => SCALARS.includes(node.kind);

/** Node of a value: a field, a group, a table, a list of groups, or a list of plain values. */
export function nodeOf(schemas, schema, value, effective, path, key, required = false) {
  const is = value ?? effective;
  const found = schemas.of(schema, is);
  const [words, unit] = schemas.label(key);
  const base = { path, key, words, unit, hint: (found.description || "").replace(/ ?\[[^\]]*\]$/, ""), required };
  if (found.type === "boolean") return { ...base, kind: "flag" };
  if (found.type === "number" || found.type === "integer") return { ...base, kind: "number", choices: [] };
  if (found.type === "object" || found.properties || found.additionalProperties)
    return group(schemas, found, value, effective, base);
  if (found.type === "array") return list(schemas, found, value, effective, base);
  if (found.names.length) return { ...base, kind: "choice", choices: found.names, open: found.open };
  return { ...base, kind: "text", choices: [] };
}

function group(schemas, found, value, effective, base) {
  const nodes = [];
  const properties = found.properties || {};
  const needed = found.required || [];
  for (const [key, schema] of Object.entries(properties)) {
    const own = value?.[key], known = effective?.[key];
    nodes.push({ given: own !== undefined || needed.includes(key),
      node: nodeOf(schemas, schema, own, known, join(base.path, key), key, needed.includes(key)) });
  }
  if (found.additionalProperties && typeof found.additionalProperties === "object")
    for (const key of Object.keys(value || {}))
      nodes.push({ given: true, node: { ...nodeOf(schemas, found.additionalProperties, value[key], effective?.[key],
        join(base.path, key), key), words: key, named: true } });
  return {
    ...base, kind: "group", is: value !== undefined,
    children: nodes.filter(each => each.given).map(each => each.node),
    more: nodes.filter(each => !each.given).map(each => each.node),
  };
}

function list(schemas, found, value, effective, base) {
  const rows = value ?? [];
  const item = schemas.resolved(found.items || {});
  const inner = schemas.of(item, rows[0] ?? effective?.[0]);
  const fromFile = value === undefined && Array.isArray(effective) && effective.length > 0;
  if (!inner.properties) return { ...base, kind: "values", count: rows.length, item, numbers: inner.type === "number" };
  const keys = Object.keys(inner.properties);
  const used = keys.filter(key => (inner.required || []).includes(key) || rows.some(row => row?.[key] !== undefined));
  const plain = rows.every(row => used.every(key => typeof row?.[key] !== "object"));
  const columns = used.map(key => nodeOf(schemas, inner.properties[key], rows[0]?.[key], undefined, key, key));
  if (plain && columns.every(isScalar) && (used.length <= MOST_COLUMNS || rows.length > ROWS_OF_A_TABLE || fromFile))
    return { ...base, kind: "table", columns, count: rows.length, fromFile, effective };
  return {
    ...base, kind: "items", count: rows.length, item,
    children: rows.map((row, i) => ({
      ...nodeOf(schemas, found.items, row, effective?.[i], `${base.path}.${i}`, base.key),
      words: String(row?.name ?? `${base.words} ${i + 1}`), named: true,
    })),
  };
}

const join = (path, key) => path ? `${path}.${key}` : key;

/** A copy of the last item with another name, to add behind it. */
export function oneMore(rows, item, schemas) {
  const last = rows.at(-1);
  if (last !== undefined) {
    if (typeof last !== "object") return last;
    const copy = structuredClone(last);
    if (typeof copy.name === "string") copy.name = fresh(copy.name, rows.map(each => each.name));
    for (const key of ["position_km", "from_km"]) if (typeof copy[key] === "number") copy[key] += 1;
    return copy;
  }
  const found = schemas.of(item);
  if (!found.properties) return found.type === "number" || found.type === "integer" ? 0 : "";
  return Object.fromEntries((found.required || []).map(key => {
    const own = schemas.of(found.properties[key]);
    const value = own.default ?? own.names[0] ?? { number: own.minimum ?? 0, integer: own.minimum ?? 1, boolean: false,
      array: [], object: {} }[own.type] ?? "new";
    return [key, value];
  }));
}

function fresh(name, taken) {
  const base = name.replace(/ \d+$/, "");
  for (let number = 2; ; number += 1) if (!taken.includes(`${base} ${number}`)) return `${base} ${number}`;
}

// What the server packs: arrays of float32 in base64.

export function unpacked(value) {
  if (value === null || typeof value !== "object" || !("f4" in value)) return value;
  const text = atob(value.f4), bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i += 1) bytes[i] = text.charCodeAt(i);
  return new Float32Array(bytes.buffer);
}

function words(value) {
  if (!value || Array.isArray(value)) return value || [];
  const which = unpacked(value.which);
  return { length: which.length, at: i => value.names[which[i]] };
}

function item(told) {
  const found = { ...told };
  for (const [name, value] of Object.entries(told)) {
    if (name === "words" && typeof value !== "string") found.words = words(value);
    else if (name === "colours" && value) found.colours = { ...value, values: unpacked(value.values) };
    else found[name] = unpacked(value);
  }
  return found;
}

/** A drawing with its arrays unpacked. */
export function drawingOf(told) {
  return { ...told, panels: told.panels.map(panel => ({ ...panel, items: panel.items.map(item) })) };
}

/** An array in which nothing is null, as uPlot wants it. */
export function withGaps(values) {
  for (let i = 0; i < values.length; i += 1)
    if (Number.isNaN(values[i])) return Array.from(values, each => Number.isNaN(each) ? null : each);
  return values;
}

// Edits in their order, those undone behind them.  An edit is a label and pairs of key path and value.

const TOGETHER_MS = 1500;

export class History {
  constructor(changed) {
    this.edits = [];
    this.undone = [];
    this.changed = changed;
    this.last = { key: "", at: 0 };
  }

  start(edits, undone) {
    this.edits = [...edits];
    this.undone = [...undone];
    this.last.key = "";
  }

  /** Add an edit; one that continues the last, by its key, takes its place. */
  push(label, pairs, key = "") {
    const now = performance.now(), previous = this.edits.at(-1);
    const continues = key && key === this.last.key && now - this.last.at < TOGETHER_MS
      && previous && previous.pairs.length === pairs.length
      && previous.pairs.every(([path], i) => path === pairs[i][0]);
    if (continues) this.edits[this.edits.length - 1] = { label, pairs };
    else this.edits.push({ label, pairs });
    this.last = { key, at: now };
    this.undone = [];
    this.changed();
  }

  /** Put one edit in place of all; undone, it leaves none. */
  replace(label, pairs) {
    this.edits = pairs.length ? [{ label, pairs }] : [];
    this.undone = [];
    this.last.key = "";
    this.changed();
  }

  undo() { return this.move(this.edits, this.undone); }

  redo() { return this.move(this.undone, this.edits); }

  move(from, to) {
    if (!from.length) return "";
    to.push(from.pop());
    this.last.key = "";
    this.changed();
    return to.at(-1).label;
  }

  pairs() { return this.edits.flatMap(each => each.pairs); }
}

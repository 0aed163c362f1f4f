// Questions that take longer than a run: asked once at a time, with a word while the server works.

import { Refused, ask } from "./server.js";

export class Asking {
  /** @param of {page, pairs, failed}: who asks, its edits, and whom to tell of failures. */
  constructor(of, what) {
    Object.assign(this, { of, what, number: 0 });
  }

  /** The answer; null if a newer question was asked, or it failed. */
  async ask(more, busy) {
    const number = (this.number += 1);
    busy?.(true);
    try {
      const told = await ask(this.what, { page: this.of.page, what: this.what, number, edits: this.of.pairs(), ...more });
      return number === this.number ? told : null;
    } catch (error) {
      if (number === this.number && !(error instanceof Refused && error.told.dropped)) this.of.failed(error);
      return null;
    } finally {
      if (number === this.number) busy?.(false);
    }
  }
}

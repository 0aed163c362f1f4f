// The draft of all edits that are not saved, kept by the server after each of them.

import { Refused, ask } from "./server.js";

const DELAY_MS = 200;

export class Drafts {
  constructor(history, overtaken, failed, settle) {
    Object.assign(this, { history, overtaken, failed, settle, revision: 0, digest: "", timer: 0, stopped: false });
    addEventListener("pagehide", () => this.flush());
  }

  start(draft, digest) {
    this.revision = draft.revision;
    this.digest = digest;
    this.stopped = false;
  }

  body() {
    const { edits, undone } = this.history;
    return { revision: this.revision, digest: this.digest, edits, undone };
  }

  get isBehind() { return !this.stopped && (this.timer !== 0 || this.keeping === true); }

  later() {
    clearTimeout(this.timer);
    if (!this.stopped) this.timer = setTimeout(() => this.keep(), DELAY_MS);
  }

  async keep() {
    this.timer = 0;
    if (this.keeping) {
      this.later();
      return;
    }
    this.keeping = true;
    try {
      this.revision = (await ask("keep-draft", this.body())).revision;
    } catch (error) {
      if (error instanceof Refused && error.told.overtaken) {
        this.stopped = true;
        this.overtaken();
      } else this.failed(error);
    } finally {
      this.keeping = false;
      this.settle();
    }
  }

  /** What waits is sent as the page goes. */
  flush() {
    if (!this.timer || this.stopped) return;
    clearTimeout(this.timer);
    this.timer = 0;
    navigator.sendBeacon("api/keep-draft", JSON.stringify(this.body()));
  }
}

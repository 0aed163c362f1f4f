// Results that follow the hand: one request at a time, then the newest edit; a long run is ended by the next.

import { Refused, ask } from "./server.js";

const PATIENCE_MS = 120;
const REST_MS = 500;
const SLOW_MS = 150;

export class Live {
  /** @param of {pairs, charts, isSound, answered, checked, failed, busy, settle}: what to ask, and whom to tell. */
  constructor(of) {
    this.of = of;
    this.page = crypto.randomUUID();
    this.number = 0;
    this.wanted = 0;
    this.done = 0;
    this.flight = null;
    this.timers = {};
  }

  /** Ask for what comes of the edits as they are now. */
  request() {
    this.wanted += 1;
    clearTimeout(this.timers.check);
    if (!this.flight) this.send();
    else if (performance.now() - this.flight.began > PATIENCE_MS) this.send();
    else if (!this.timers.next) {
      const rest = PATIENCE_MS - (performance.now() - this.flight.began);
      this.timers.next = setTimeout(() => { this.timers.next = 0; this.catchUp(); }, rest);
    }
  }

  get isBusy() { return this.flight !== null || this.done !== this.wanted; }

  catchUp() { if (this.flight && this.flight.wanted < this.wanted) this.send(); }

  async send() {
    const flight = { number: (this.number += 1), wanted: this.wanted, began: performance.now() };
    this.flight = flight;
    clearTimeout(this.timers.slow);
    this.timers.slow = setTimeout(() => this.of.busy(true), SLOW_MS);
    try {
      const body = { page: this.page, number: flight.number, edits: this.of.pairs(), charts: this.of.charts() };
      const answer = await ask("see", body);
      if (flight === this.flight) this.of.answered(answer);
    } catch (error) {
      if (flight === this.flight && !(error instanceof Refused && error.told.dropped)) this.of.failed(error);
    }
    if (flight !== this.flight) return;
    this.flight = null;
    this.done = flight.wanted;
    clearTimeout(this.timers.slow);
    this.of.busy(false);
    this.of.settle();
    if (flight.wanted < this.wanted) this.send();
    else if (this.of.isSound()) this.timers.check = setTimeout(() => this.check(), REST_MS);
  }

  /** Once the hand rests: step error and notes. */
  async check() {
    const wanted = this.wanted;
    try {
      const body = { page: this.page, number: (this.number += 1), edits: this.of.pairs() };
      const told = await ask("check", body);
      if (wanted === this.wanted) this.of.checked(told);
    } catch (error) {
      if (wanted === this.wanted && !(error instanceof Refused)) this.of.failed(error);
    }
  }
}

/** Play, step and seek: a button, a slider over the frames, the time, the speed. */

import { make } from "./charts.js";
import { shown } from "./colours.js";

const LASTS = 8;

export class Player {
  /** times : s, of the frames;  show : called with the number of a frame, gives a promise that it is drawn. */
  constructor(times, show) {
    Object.assign(this, { times, show, at: 0, playing: false, rates: [] });
    this.button = make("button", { type: "button", class: "play", "aria-label": "play", onclick: () => this.toggle() }, "▶");
    this.slider = make("input", { type: "range", min: 0, max: Math.max(0, times.length - 1), value: 0, step: 1,
      "aria-label": "frame", oninput: () => this.seek(Number(this.slider.value)) });
    this.text = make("output", { class: "time" });
    this.speed = make("select", { "aria-label": "speed" }, ...[0.25, 0.5, 1, 2, 4].map((it) =>
      make("option", { value: it, selected: it === 1 }, `${it} ×`)));
    this.element = make("div", { class: "player" }, this.button, this.slider, this.text, this.speed);
    this.element.hidden = times.length < 1;
  }

  /** Show frame i, as near as there is one. */
  seek(i) {
    this.at = Math.min(this.times.length - 1, Math.max(0, i));
    this.slider.value = this.at;
    const time = this.times[this.at];
    this.text.textContent = `t = ${shown(time)} s · ${this.at + 1} of ${this.times.length}`;
    this.slider.setAttribute("aria-valuetext", `${shown(time)} s, frame ${this.at + 1} of ${this.times.length}`);
    return this.show(this.at);
  }

  toggle(on = !this.playing) {
    if (on === this.playing || this.times.length < 2) return;
    this.playing = on;
    this.button.textContent = on ? "❚❚" : "▶";
    this.button.setAttribute("aria-label", on ? "pause" : "play");
    if (on) this.loop();
  }

  /** Frame after frame, each drawn before the next is due; from the start again at the end. */
  async loop() {
    if (this.at >= this.times.length - 1) this.at = -1;
    this.rates = [];
    let due = performance.now();
    while (this.playing && this.at < this.times.length - 1) {
      const rate = Math.min(30, Math.max(5, this.times.length / LASTS)) * Number(this.speed.value);
      const begun = performance.now();
      await this.seek(this.at + 1);
      due = Math.max(due + 1000 / rate, performance.now() - 200);
      this.rates.push(performance.now() - begun);
      const wait = due - performance.now();
      await new Promise((done) => (wait > 4 ? setTimeout(done, wait) : requestAnimationFrame(done)));
    }
    this.toggle(false);
  }

  /** Keys of the page: space, arrows, home, end. */
  key(event) {
    const steps = { ArrowLeft: -1, ArrowRight: 1, PageUp: -10, PageDown: 10 };
    if (event.key === " ") this.toggle();
    else if (event.key in steps) this.seek(this.at + steps[event.key]);
    else if (event.key === "Home") this.seek(0);
    else if (event.key === "End") this.seek(this.times.length - 1);
    else return;
    event.preventDefault();
  }
}

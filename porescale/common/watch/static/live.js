/** A run that is read while it may grow, from a server or a kernel: Remote is its source, follow keeps a page of it new. */

import { make } from "./charts.js";
import { shown } from "./colours.js";
import { openReport } from "./report.js";

const EVERY = 1000;
const HIDDEN = 5000;

export class Remote {
  /** ask : gives the ArrayBuffer of "state", "meta", "news", "frame/3" or "table/series". */
  constructor(ask) {
    Object.assign(this, { ask, about: null, others: [] });
  }

  async json(name) {
    return JSON.parse(new TextDecoder().decode(await this.ask(name)));
  }

  /** All that is known of the run; once it is, only what changes is asked for. */
  async meta() {
    this.about = this.about ? { ...this.about, ...(await this.json("news")) } : await this.json("meta");
    return { ...this.about };
  }

  frame(i) {
    return this.ask(`frame/${i}`);
  }

  table(name) {
    return this.json(`table/${encodeURIComponent(name)}`);
  }

  state() {
    return this.json("state");
  }
}

/** What a server below this page has of a name. */
export async function ask(name) {
  const answer = await fetch(name, { cache: "no-store" });
  if (!answer.ok) throw new Refused(`${await answer.text()}`);
  return answer.arrayBuffer();
}

export class Refused extends Error {}

const pause = (seconds) => new Promise((done) => setTimeout(done, seconds));

/** Call `look` again and again, a second or so apart, until it gives true; what it throws is said by `say`. */
export async function again(look, say) {
  for (;;) {
    const begun = performance.now();
    try {
      if (await look()) return;
    } catch (error) {
      if (error instanceof Refused) say(error.message, "open");
      else if (error instanceof TypeError) say("no longer watched: the command `watch` has ended; what was read is shown", "ended");
      else throw error;
    }
    await pause(Math.max(document.hidden ? HIDDEN : EVERY, 2 * (performance.now() - begun)));
  }
}

/** What a run is at, in words. */
export function progress({ outcome, problem, time, end, steps, age }) {
  const words = [outcome || "run"];
  if (time !== null) words.push(`t = ${shown(time)}${end ? ` of ${shown(end)}` : ""} s`);
  if (time !== null && end) words.push(`${Math.min(100, Math.floor((100 * time) / end))} %`);
  words.push(`${steps.length} frame${steps.length === 1 ? "" : "s"}`);
  if (outcome === "running") words.push(`last written ${ago(age)} ago`);
  if (problem) words.push(problem);
  return words.join(" · ");
}

/** Seconds in the unit that says enough. */
export const ago = (seconds) =>
  seconds < 90 ? `${Math.round(seconds)} s` : seconds < 5400 ? `${Math.round(seconds / 60)} min` : `${Math.round(seconds / 3600)} h`;

const grown = (now, before) =>
  now.steps.length !== before.steps.length || now.outcome !== before.outcome || JSON.stringify(now.tables) !== JSON.stringify(before.tables);

/** The page of a run in an element, kept new while the element is there;  ends : and while the run is running;
 *  back : where a link to all runs leads. */
export async function follow(element, source, { ends = false, back = "" } = {}) {
  const line = make("p", { class: "live", role: "status" }, "reading the run …");
  const say = (text, state) => {
    line.textContent = text;
    line.dataset.state = state;
  };
  let [seen, report, place] = [null, null, null];
  element.replaceChildren(line, ...(back ? [make("a", { class: "back", href: back }, "← all runs")] : []));
  const look = async () => {
    if (seen && !element.isConnected) return true;
    const state = await source.state();
    if (seen) say(progress(state), state.outcome); // at first it says that it reads, until there is a picture
    const anew = !seen || state.epoch !== seen.epoch || (!seen.steps.length && state.steps.length > 0);
    if (anew) {
      source.about = null;
      place?.remove();
      place = make("main");
      element.append(place);
      report = await openReport(place, source);
      await report.player?.seek(state.steps.length - 1);
      say(progress(state), state.outcome);
    } else if (grown(state, seen)) await report.refresh();
    seen = state;
    element.report = report;
    return ends && state.outcome !== "running";
  };
  await again(look, say);
}

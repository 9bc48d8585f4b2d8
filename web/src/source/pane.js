// Shows one pane of the source view: lines with their cost, of which one is chosen and some are marked.
// SPDX-License-Identifier: Apache-2.0
import { h } from "../dom.js";
import { fill } from "./heat.js";

const kPage = 20; // lines of Page Up and Page Down

let panes = 0; // number of panes so far: names of lines are unique in a page with several views

export class Pane {
  // `act` is {choose(kind, key), point(kind, key or null), leave(kind, step)}.
  constructor(kind, title, act) {
    this.kind = kind;
    this.name = `pane-${panes++}`;
    this.act = act;
    this.lines = []; // {key, row, cell}
    this.heading = h("h3", {}, title);
    this.note = h("span", { class: "sum" });
    this.list = h("div", { class: "lines", role: "listbox", tabindex: "0", "aria-label": title, onkeydown: (event) => this.key(event) });
    for (const [type, does] of [["click", act.choose], ["mouseover", act.point]])
      this.list.addEventListener(type, (event) => {
        const row = event.target.closest("[data-key]");
        if (row) does(kind, this.lines[Number(row.dataset.key)].key);
      });
    this.list.addEventListener("mouseleave", () => act.point(kind, null));
    this.element = h("div", { class: `pane ${kind}` }, h("div", { class: "head" }, this.heading, this.note), this.list);
  }

  // Shows lines, which are {key, number, text, title}.
  show(lines) {
    this.byKey = new Map();
    this.lines = lines.map(({ key, number, text, title }, i) => {
      const cell = h("span", { class: "cost" });
      const row = h("div", { role: "option", id: `${this.name}-${i}`, "data-key": String(i), title }, cell, h("span", { class: "no" }, String(number)), h("code", {}, text || " "));
      this.byKey.set(key, i);
      return { key, row, cell };
    });
    this.list.replaceChildren(h("div", { class: "sheet" }, this.lines.map(({ row }) => row)));
    this.list.scrollTop = 0;
  }

  // Shows the costs of the lines. `costs` maps keys to costs.
  heat(costs, measure, context) {
    const values = this.lines.map(({ key }) => (costs.has(key) ? measure.value(costs.get(key), context) : 0));
    const most = measure.most ? measure.most() : values.reduce((a, b) => Math.max(a, b), 0);
    for (const { key, cell } of this.lines) fill(cell, costs.get(key), measure, most, context);
  }

  // Marks `keys`. `chosen` is the line that the user is at, if it is in this pane.
  mark(keys, chosen) {
    for (const { key, row } of this.lines) {
      row.classList.toggle("on", keys.has(key));
      row.setAttribute("aria-selected", String(key === chosen));
    }
    const at = this.byKey?.get(chosen);
    if (at === undefined) this.list.removeAttribute("aria-activedescendant");
    else this.list.setAttribute("aria-activedescendant", `${this.name}-${at}`);
  }

  // Brings the first of `keys` into view, if none of them is.
  reveal(keys) {
    const rows = this.lines.filter(({ key }) => keys.has(key)).map(({ row }) => row);
    const { scrollTop, clientHeight } = this.list;
    if (!rows.length || rows.some((row) => row.offsetTop >= scrollTop && row.offsetTop + row.offsetHeight <= scrollTop + clientHeight)) return;
    this.list.scrollTop = rows[0].offsetTop - clientHeight / 3;
  }

  key(event) {
    const last = this.lines.length - 1;
    const at = this.lines.findIndex(({ row }) => row.getAttribute("aria-selected") === "true");
    const to = { ArrowDown: at + 1, ArrowUp: at - 1, PageDown: at + kPage, PageUp: at - kPage, Home: 0, End: last }[event.key];
    if (to !== undefined && last >= 0) this.act.choose(this.kind, this.lines[Math.max(0, Math.min(last, to))].key);
    else if (event.key === "ArrowLeft" || event.key === "ArrowRight") this.act.leave(this.kind, event.key === "ArrowLeft" ? -1 : 1);
    else return;
    event.preventDefault();
  }
}

// What all parts of the page use: the data it carries, its colours, and small makers of elements.
"use strict";
const grandamp = {
  report: JSON.parse(document.getElementById("report").textContent),
  dark: matchMedia("(prefers-color-scheme: dark)"),
  redraws: [], // called when the colours change

  /** Numbers of a data element, as a typed array. */
  data(name, Type) {
    const text = document.getElementById("data-" + name).textContent;
    if (Uint8Array.fromBase64) return new Type(Uint8Array.fromBase64(text).buffer);
    const raw = atob(text), bytes = new Uint8Array(raw.length);
    for (let k = 0; k < raw.length; ++k) bytes[k] = raw.charCodeAt(k);
    return new Type(bytes.buffer);
  },

  /** A custom property of the style sheet. */
  style(name) {
    return getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
  },

  /** Dark lines are lightened on a dark ground. */
  colour(hex) {
    const lighter = { "#0072b2": "#4aa8e0", "#009e73": "#2fc79a", "#d55e00": "#f0823a", "#5f6b76": "#9fb0bd", "#1f4e79": "#6aa5d8",
      "#b3541e": "#e8874f", "#2e7d32": "#63b868", "#7b1fa2": "#c583e0", "#00838f": "#3fb9c5", "#ad1457": "#ee6f9f", "#d32f2f": "#ff7a70" };
    return grandamp.dark.matches && lighter[hex] || hex;
  },

  /** Enough digits to tell a number from its neighbours `step` away. */
  digits(value, step) {
    if (!isFinite(value)) return "";
    const size = Math.max(Math.abs(value), Math.abs(step));
    if (size !== 0 && (size >= 1e6 || size < 1e-4)) return value.toExponential(2);
    const places = step > 0 ? Math.max(0, Math.min(8, Math.ceil(-Math.log10(step)))) : 3;
    return value.toFixed(places);
  },

  element(name, attributes, ...children) {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(attributes || {})) {
      if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
      else if (value === true) made.setAttribute(key, "");
      else if (value !== false && value !== null) made.setAttribute(key, value);
    }
    made.append(...children);
    return made;
  },

  /** Calls `draw` once the element is about to be seen. */
  when_near(element, draw) {
    const watch = new IntersectionObserver(entries => {
      if (!entries.some(entry => entry.isIntersecting)) return;
      watch.disconnect();
      draw();
    }, { rootMargin: "400px" });
    watch.observe(element);
  },

  figures(kind) {
    return [...document.querySelectorAll(`figure[data-kind="${kind}"]`)].map(element => ({
      element, live: element.querySelector(".live"), facts: grandamp.report.figures[element.id],
      title: element.querySelector("h3").textContent }));
  },

  /** A figure that cannot come alive keeps its still picture. */
  keep_still(figure, why) {
    figure.element.classList.remove("lives");
    figure.live.replaceWith(grandamp.element("p", { class: "note" }, why));
  },
};
grandamp.dark.addEventListener("change", () => grandamp.redraws.forEach(redraw => redraw()));

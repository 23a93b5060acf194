// The last script: the page is alive.
"use strict";
document.documentElement.classList.add("scripted");
document.documentElement.dataset.ready = String(Math.round(performance.now()));

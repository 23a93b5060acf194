// The granules in their enclosure: turning, playing, coloured.
"use strict";
grandamp.granules = null;
grandamp.show_granules = figure => {
  const facts = figure.facts, { count, frames } = facts;

  const canvas = document.createElement("canvas");
  const context = canvas.getContext("webgl2", { antialias: true, alpha: true }) || canvas.getContext("webgl", { antialias: true, alpha: true });
  const can = context && (window.WebGL2RenderingContext && context instanceof WebGL2RenderingContext ||
    context.getExtension("EXT_frag_depth") && context.getExtension("ANGLE_instanced_arrays"));
  if (!can) {
    grandamp.keep_still(figure, "This browser draws nothing in three dimensions here (WebGL): the picture stands still.");
    return;
  }
  const renderer = new THREE.WebGLRenderer({ canvas, context });

  const places = grandamp.data("places", Uint16Array);
  const radii = grandamp.data("radii", Float32Array);
  const shades = {}; // of every way to colour: bytes, per frame or once
  for (const way of facts.ways) shades[way.name] = grandamp.data("shade-" + way.name, Uint8Array);

  const scene = new THREE.Scene(), moving = new THREE.Group();
  scene.add(moving);
  const spheres = grandamp.spheres.make(radii, facts.low, facts.span);
  moving.add(spheres.mesh);
  const walls = new THREE.LineSegments(new THREE.BufferGeometry().setAttribute("position",
    new THREE.BufferAttribute(new Float32Array(facts.edges), 3)), new THREE.LineBasicMaterial());
  moving.add(walls);

  const size = Math.hypot(...facts.enclosure.size), middle = new THREE.Vector3(...facts.enclosure.size.map((s, k) => facts.enclosure.low[k] + s / 2));
  const camera = new THREE.PerspectiveCamera(30, 1, size * 0.01, size * 20);
  camera.up.set(0, 0, 1);
  const controls = new THREE.OrbitControls(camera, renderer.domElement);
  controls.target.copy(middle);
  controls.enableKeys = false;
  controls.minDistance = size * 0.3;
  controls.maxDistance = size * 8;
  controls.enableZoom = false; // by the wheel only once the picture has the focus: the page scrolls over it
  controls.addEventListener("change", () => { dirty = true; });

  let frame = frames - 1, way = facts.ways[0], playing = false, speed = 25, follow = false, dirty = true, last = 0, drawn = 0;

  function look(x, y, z) {
    const aspect = Math.min(1, camera.aspect || 1);
    camera.position.copy(new THREE.Vector3(x, y, z).normalize().multiplyScalar(size * 1.75 / aspect).add(middle));
    controls.update();
    dirty = true;
  }

  function turn(azimuth, height, nearer) {
    const spherical = new THREE.Spherical(), across = new THREE.Quaternion().setFromUnitVectors(camera.up, new THREE.Vector3(0, 1, 0));
    const offset = camera.position.clone().sub(controls.target).applyQuaternion(across);
    spherical.setFromVector3(offset);
    spherical.theta += azimuth;
    spherical.phi += height;
    spherical.radius = Math.min(Math.max(spherical.radius * nearer, controls.minDistance), controls.maxDistance);
    spherical.makeSafe();
    camera.position.copy(new THREE.Vector3().setFromSpherical(spherical).applyQuaternion(across.inverse()).add(controls.target));
    controls.update();
    dirty = true;
  }

  function place_frame() {
    spheres.places(places.subarray(3 * count * frame, 3 * count * (frame + 1)));
    const bytes = shades[way.name];
    spheres.values(bytes.length === count ? bytes : bytes.subarray(count * frame, count * (frame + 1)));
    const shift = follow ? facts.displacement[frame] : 0;
    moving.position.set(...facts.direction.map(d => d * shift));
    slider.value = frame;
    const slower = frames > 1 ? (facts.times[frames - 1] - facts.times[0]) / (frames - 1) * speed : 0;
    readout.textContent = `${facts.times[frame].toPrecision(4)} s` + (frames > 1 ? `, picture ${frame + 1} of ${frames}` : "") +
      (slower > 0 && slower < 0.95 ? `; plays ${Number((1 / slower).toPrecision(2))} times slower than life` : "");
    slider.setAttribute("aria-valuetext", `${facts.times[frame].toPrecision(4)} s`);
    figure.element.dataset.frame = frame;
    dirty = true;
  }

  function colour_by(name) {
    way = facts.ways.find(one => one.name === name);
    spheres.colours(way.colours, way.smooth);
    if (way.smooth) ramp.replaceChildren(way.from, grandamp.element("span", { class: "bar", style: `background:linear-gradient(90deg,${way.colours.join()})` }), way.to);
    else ramp.replaceChildren(...way.names.map((text, k) => grandamp.element("span", {}, grandamp.element("i", { style: "background:" + way.colours[k] }), text)));
    place_frame();
  }

  function play(on) {
    playing = on;
    last = performance.now();
    button.textContent = playing ? "Pause" : "Play";
    button.setAttribute("aria-pressed", String(playing));
    if (playing && frame === frames - 1) frame = 0;
  }

  const { element } = grandamp;
  const viewer = element("div", { class: "viewer" });
  const readout = element("span", { class: "readout" });
  const button = element("button", { type: "button", "aria-pressed": "false", onclick: () => play(!playing) }, "Play");
  const slider = element("input", { type: "range", min: 0, max: frames - 1, value: 0, "aria-label": "Picture", oninput: () => { play(false); frame = Number(slider.value); place_frame(); } });
  const speeds = element("select", { "aria-label": "Speed", onchange: () => { speed = Number(speeds.value); place_frame(); } },
    ...[5, 10, 25, 50].map(n => element("option", { value: n, selected: n === speed }, `${n} pictures a second`)));
  const ways = element("select", { onchange: () => colour_by(ways.value) }, ...facts.ways.map(one => element("option", { value: one.name }, one.label)));
  const ramp = element("div", { class: "ramp", role: "img", "aria-label": "scale of colours" });
  const view = (text, ...from) => element("button", { type: "button", onclick: () => look(...from) }, text);
  const swing = element("input", { type: "checkbox", onchange: () => { follow = swing.checked; place_frame(); } });
  if (frames > 1) figure.live.append(element("div", { class: "controls" }, button, slider, speeds));
  figure.live.append(viewer, element("div", { class: "controls" }, readout));
  figure.live.append(element("div", { class: "controls" }, element("label", {}, "Colour by ", ways), ramp));
  figure.live.append(element("div", { class: "controls" }, view("Corner", 1, -1.7, 0.75), view("Front", 0, -1, 0.001), view("Side", 1, 0, 0.001), view("Top", 0, -0.001, 1),
    ...(facts.displacement ? [element("label", {}, swing, "move with the structure")] : [])));

  canvas.tabIndex = 0;
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", `${figure.title}. Arrow keys turn it, plus and minus zoom, space plays.`);
  viewer.append(canvas);
  canvas.addEventListener("pointerdown", () => canvas.focus({ preventScroll: true }));
  canvas.addEventListener("focus", () => { controls.enableZoom = true; });
  canvas.addEventListener("blur", () => { controls.enableZoom = false; });
  canvas.addEventListener("keydown", event => {
    const step = 0.12, keys = { ArrowLeft: [-step, 0, 1], ArrowRight: [step, 0, 1], ArrowUp: [0, -step, 1], ArrowDown: [0, step, 1], "+": [0, 0, 0.88], "=": [0, 0, 0.88], "-": [0, 0, 1.14] };
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === " " && frames > 1) play(!playing);
    else if (keys[event.key]) turn(...keys[event.key]);
    else return;
    event.preventDefault();
  });

  function recolour() {
    walls.material.color.set(grandamp.style("soft"));
    dirty = true;
  }

  function fit() {
    const wide = viewer.clientWidth, high = viewer.clientHeight;
    if (!wide || !high) return;
    const first = camera.userData.fitted !== true;
    renderer.setSize(wide, high);
    camera.aspect = wide / high;
    camera.updateProjectionMatrix();
    camera.userData.fitted = true;
    if (first) look(1, -1.7, 0.75);
    dirty = true;
  }

  // While it moves as fine as the machine can draw it smoothly; at rest finer than the screen.
  const screen_ratio = Math.min(devicePixelRatio || 1, 2);
  let rough = screen_ratio, rested = false, moved_at = 0;
  function render(now) {
    if (dirty) {
      const pause = now - moved_at;
      if (pause < 400) rough = pause > 55 ? Math.max(0.4, 0.85 * rough) : pause < 25 ? Math.min(screen_ratio, 1.1 * rough) : rough;
      moved_at = now;
      rested = dirty = false;
      if (renderer.getPixelRatio() !== rough) renderer.setPixelRatio(rough);
    } else if (!rested && !playing && now - moved_at > 250) {
      rested = true;
      renderer.setPixelRatio(rough < screen_ratio ? screen_ratio : 2);
    } else return;
    renderer.render(scene, camera);
    ++drawn;
  }

  function step(now) {
    if (playing && now - last >= 1000 / speed) {
      const steps = Math.floor((now - last) * speed / 1000);
      last += steps * 1000 / speed;
      if (frame + steps >= frames && frame === frames - 1) play(false);
      else { frame = Math.min(frame + steps, frames - 1); place_frame(); }
    }
    render(now);
    requestAnimationFrame(step);
  }

  recolour();
  colour_by(way.name);
  grandamp.redraws.push(recolour);
  new ResizeObserver(fit).observe(viewer);
  fit();
  requestAnimationFrame(step);
  grandamp.granules = { frame: () => frame, playing: () => playing, drawn: () => drawn, turn, play };
};
// Making it takes a moment, which the page need not wait for.
for (const figure of grandamp.figures("granules")) grandamp.when_near(figure.element, () => grandamp.show_granules(figure));

"use strict";
/* The report's interactive part: settings go to the C library, compiled to WebAssembly, in a worker of this page; its
 * figures and histories come back and are drawn.  The page has the module in #trum-module (base64) and the motor's
 * values in #trum-values (JSON); window.trumMotor is for tests and for the curious. */
(() => {
  const SAMPLES_PER_PERIOD = 48, HEIGHT = 170, TOLERANCE = 1e-9, LOADS = 24, MOST_LAPS = 60;

  /* Runs in the worker, or here if there is none: answers {values, count} with {settings, figures, histories},
   * {values, loads} with the mean speeds under these loads, and {values, count, laps} with the moving picture. */
  function engine(bytes, answer) {
    const library = WebAssembly.instantiate(bytes, {}).then(({ instance }) => {
      const c = instance.exports;
      const text = (at) => {
        const memory = new Uint8Array(c.memory.buffer);
        return new TextDecoder().decode(memory.slice(at, memory.indexOf(0, at)));
      };
      const places = text(c.places()).trim().split("\n").map((line) => line.split(" "));
      const of = (...kinds) => places.filter((place) => kinds.includes(place[0]));
      return { c, text, settings: of("number", "choice"), figures: of("figure"), histories: of("history") };
    });
    function enter({ c, settings }, values) {
      c.reset();
      const given = new Float64Array(c.memory.buffer, c.settings(), settings.length);
      for (const [name, value] of Object.entries(values)) {
        const kind = typeof value === "string" ? "choice" : "number";
        const place = settings.findIndex((setting) => setting[0] === kind && setting[1] === name);
        if (place < 0) throw new Error(name + " is no setting");
        given[place] = kind === "choice" ? settings[place].slice(2).indexOf(value) : value;
      }
      return given;
    }
    /* Mean speeds under several loads, NaN where none balances. */
    async function underLoad({ values, loads, serial }) {
      const { c, settings, figures } = await library;
      const at = figures.findIndex((figure) => figure[1] === "mean_speed");
      const speeds = loads.map((load) => {
        enter({ c, settings }, { ...values, load_torque: load });
        c.solve(1);
        return new Float64Array(c.memory.buffer, c.figures(), figures.length)[at];
      });
      return { loads, speeds, serial };
    }
    /* Surface and crest's path at every sample, row after row; the rotor's cycles from rest until two end alike. */
    async function film({ values, count, laps, serial }) {
      const { c, settings } = await library;
      enter({ c, settings }, values);
      const used = Math.min(count, c.most_samples()), columns = c.columns(), points = c.path_points();
      c.solve(used);
      const view = (at, length) => new Float64Array(c.memory.buffer, at, length);
      const heights = new Float32Array((used + 1) * columns);
      const along = new Float32Array((used + 1) * points), up = new Float32Array((used + 1) * points);
      let known = true;
      for (let i = 0; i <= used && known; i++) {
        known = Boolean(c.picture(i));
        heights.set(view(c.heights(), columns), i * columns);
        along.set(view(c.path_along(), points), i * points);
        up.set(view(c.path_up(), points), i * points);
      }
      const speeds = [], ways = [];
      for (let k = 0, alike = 0, end = 0; k < laps && alike < 2 && known && c.lap(); k++) {
        const speed = Float32Array.from(view(c.lap_speed(), used));
        const large = speed.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
        alike = Math.abs(speed[used - 1] - end) < 1e-3 * large ? alike + 1 : 0;
        end = speed[used - 1];
        speeds.push(speed);
        ways.push(Float32Array.from(view(c.lap_way(), used)));
      }
      return { film: known, serial, count: used, columns, points, length: c.length(), heights, along, up, speeds, ways };
    }
    async function solve(job) {
      if (job.loads) return underLoad(job);
      if (job.laps) return film(job);
      const { values, count } = job;
      const { c, text, settings, figures, histories } = await library;
      const given = enter({ c, settings }, values);
      const used = Math.min(count, c.most_samples());
      const status = c.solve(used);
      const row = c.most_samples() + 1;
      const found = (all, at) => Object.fromEntries(all.map(([, name], i) => [name, at(i)]));
      const numbers = new Float64Array(c.memory.buffer, c.figures(), figures.length);
      const field = numbers[figures.findIndex((figure) => figure[1] === "field")];
      return {
        settings: found(settings, (i) => settings[i][0] === "choice" ? settings[i][2 + given[i]] : given[i]),
        figures: found(figures, (i) => numbers[i]),
        histories: found(histories, (i) => new Float64Array(c.memory.buffer, c.histories() + 8 * row * i, used + 1).slice()),
        message: text(c.status_text(status)), field: field >= 0 ? settings[field][1] : null,
      };
    }
    return (job) => solve(job).then(answer, (problem) => answer({ error: String(problem) }));
  }

  function background(bytes, answer) {
    const source = `const engine = ${engine.toString()};
      let run;
      onmessage = ({ data }) => { if (run) run(data); else run = engine(data, (found) => postMessage(found)); };`;
    let worker;
    try {
      worker = new Worker(URL.createObjectURL(new Blob([source], { type: "text/javascript" })));
    } catch { /* a policy of the page's host forbids it */
      const run = engine(bytes, answer);
      return (job) => setTimeout(run, 0, job);
    }
    worker.onmessage = ({ data }) => answer(data);
    worker.onerror = (event) => answer({ error: event.message });
    worker.postMessage(bytes);
    return (job) => worker.postMessage(job);
  }

  /* --- drawing --- */
  const SVG = "http://www.w3.org/2000/svg";
  function element(parent, name, attributes, text) {
    const made = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    if (text !== undefined) made.textContent = text;
    parent.append(made);
    return made;
  }
  const finite = (list) => list.filter(Number.isFinite);
  const shown = (x) => !Number.isFinite(x) ? "–" : x === 0 ? "0" : Math.abs(x) >= 1e5 || Math.abs(x) < 1e-3
    ? x.toExponential(3).replace("-", "−").replace("e+", "e") : x.toPrecision(5).replace("-", "−");
  function ticks(low, high, about) {
    const rough = (high - low) / about, power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((f) => f * power).find((s) => s >= rough);
    const first = Math.ceil(low / step - 1e-9);
    return Array.from({ length: Math.floor(high / step + 1e-9) - first + 1 }, (_, i) => step * (first + i));
  }
  const label = (x) => String(parseFloat(x.toPrecision(6))).replace("-", "−");

  /* Axes of one picture: returns functions from data to pixels and helpers that draw. */
  function axes(svg, x, y, names, height = HEIGHT, marks = {}) {
    const width = Math.max(220, svg.parentElement.clientWidth);
    const left = 48, right = width - 14, top = 8, bottom = height - 32;
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    svg.replaceChildren();
    if (!(y[1] > y[0])) y = [-1, 1];
    const X = (a) => left + (right - left) * (a - x[0]) / (x[1] - x[0]);
    const Y = (b) => bottom - (bottom - top) * (b - y[0]) / (y[1] - y[0]);
    const path = (xs, ys, kind, close = "") => {
      let d = "", pen = "M";
      for (let i = 0; i < xs.length; i++) {
        if (!Number.isFinite(ys[i])) { pen = "M"; continue; }
        d += pen + X(xs[i]).toFixed(1) + " " + Y(ys[i]).toFixed(1);
        pen = "L";
      }
      return element(svg, "path", { d: d + close, class: kind });
    };
    const frame = () => {
      for (const at of marks.x ?? ticks(x[0], x[1], Math.min(8, (right - left) / 60))) {
        element(svg, "path", { d: `M${X(at)} ${bottom}v4`, class: "axis" });
        element(svg, "text", { x: X(at), y: bottom + 15, "text-anchor": "middle" }, label(at));
      }
      for (const at of marks.y ?? ticks(y[0], y[1], 4)) {
        element(svg, "path", { d: `M${left} ${Y(at)}H${right}`, class: Math.abs(at) < 1e-12 * (y[1] - y[0]) ? "zero" : "axis" });
        element(svg, "text", { x: left - 4, y: Y(at) + 4, "text-anchor": "end" }, label(at));
      }
      element(svg, "text", { x: right, y: height - 4, "text-anchor": "end" }, names[0]);
      element(svg, "text", { x: 2, y: top + 3 }, names[1]);
    };
    const band = (from, to) => element(svg, "rect", { x: X(from), y: top, width: Math.max(0, X(to) - X(from)),
      height: bottom - top, class: "off" });
    const cursor = (at) => element(svg, "path", { d: `M${X(at)} ${top}V${bottom}`, class: "cursor" });
    const dot = (a, b) => Number.isFinite(b) && element(svg, "circle", { cx: X(a), cy: Y(b), r: 4, class: "dot" });
    return { path, frame, band, cursor, dot, aspect: (right - left) / (bottom - top) };
  }
  function span(...lists) {
    const all = finite(lists.flatMap((list) => [...list]));
    if (!all.length) return [-1, 1];
    const low = all.reduce((a, b) => Math.min(a, b)), high = all.reduce((a, b) => Math.max(a, b));
    const margin = 0.06 * (high - low) || 1;
    return [low - margin, high + margin];
  }
  const scaled = (list, factor) => Array.from(list, (value) => value * factor);

  function draw(root, state, instant) {
    const { figures, histories } = state, count = histories.w_A.length - 1;
    const whole = 1e3 * figures.cycle_time, time = Array.from({ length: count + 1 }, (_, i) => whole * i / count);
    const now = Math.round(instant * count), at = time[now], name = (plot) => root.querySelector(`[data-plot=${plot}]`);
    const say = (plot, words) => name(plot).setAttribute("aria-label", words);
    const known = Number.isFinite(histories.w_A[0]);
    if (!known) {
      for (const svg of root.querySelectorAll("svg")) svg.replaceChildren(), svg.setAttribute("aria-label", "nothing to draw");
      return;
    }
    const regions = [0, 1e3 * figures.region_1, 1e3 * figures.region_2];
    const quarters = [-180, -90, 0, 90, 180];
    const over = (plot, ys, unit, then, marks) => {
      const box = axes(name(plot), [0, whole], ys, ["ms", unit], HEIGHT, marks);
      box.band(regions[0], regions[1]);
      box.band(regions[1] + (regions[2] > regions[1] ? 1e-3 * whole : 0), regions[2]);
      box.frame();
      then(box);
      box.cursor(at);
    };
    const a = scaled(histories.w_A, 1e6), b = scaled(histories.w_B, 1e6);
    over("phases", span(a, b), "µm", (box) => { box.path(time, b, "line-b"); box.path(time, a, "line-a"); });
    say("phases", `Displacement of phases A and B over a cycle of ${shown(whole)} milliseconds, up to `
      + `${shown(Math.max(...finite(a), ...finite(b)))} micrometres`);

    const q = scaled(histories.Q, 1e6);
    over("determinant", span(q, [0]), "mm²/s", (box) => {
      const ends = [time[count], 0];
      box.path([...time, ...ends], [...q.map((v) => Math.max(v, 0)), 0, 0], "fore", "Z");
      box.path([...time, ...ends], [...q.map((v) => Math.min(v, 0)), 0, 0], "back", "Z");
    });
    say("determinant", `Direction determinant over the cycle; Q_aver is ${shown(figures.q_average)} per second`);

    const angle = scaled(histories.theta, 180 / Math.PI);
    over("zone", [-215, 215], "°", (box) => {
      box.path([...time, ...[...time].reverse()], [...angle, ...angle.map((v) => -v).reverse()], "touch", "Z");
    }, { y: quarters });
    say("zone", `Half-angle of the contact from ${shown(Math.min(...angle))} to ${shown(Math.max(...angle))} degrees`);

    const speed = histories.rotor_speed;
    over("speed", span(speed, [0]), "rad/s", (box) => {
      box.path(time, speed, "line");
      box.path([0, whole], [figures.mean_speed, figures.mean_speed], "mean");
    });
    say("speed", `Rotor speed from ${shown(figures.min_speed)} to ${shown(figures.max_speed)} radians per second, mean `
      + shown(figures.mean_speed));
  }

  function drawLoad(root, { loads, speeds }, here) {
    const svg = root.querySelector('[data-plot="load"]');
    const box = axes(svg, [loads[0], loads[loads.length - 1]], span(speeds, [0]), ["N m", "rad/s"]);
    box.frame();
    box.path(loads, speeds, "line");
    if (here.load >= loads[0] && here.load <= loads[loads.length - 1]) box.dot(here.load, here.speed);
    svg.setAttribute("aria-label", `Mean speed from ${shown(speeds[0])} radians per second without load to `
      + `${shown(finite([...speeds]).at(-1))} at the greatest load that a speed balances; this drive's is ${shown(here.speed)}`);
  }

  /* --- the controls --- */
  function begin(root) {
    const bytes = Uint8Array.from(atob(document.getElementById("trum-module").textContent.trim()), (c) => c.charCodeAt(0));
    const motor = JSON.parse(document.getElementById("trum-values").textContent);
    const inputs = [...root.querySelectorAll("[data-setting]")], note = root.querySelector(".trum-note");
    const waiting = [], instants = [...root.querySelectorAll("[data-instant]")];
    let values = {}, state = null, instant = 0.6, busy = false, pending = false, serial = 0, curve = null;
    const moving = window.trumMoving(root, (at) => {
      instant = at;
      for (const input of instants) input.value = (100 * at).toFixed(1);
      draw(root, state, instant);
    });
    const post = background(bytes, (found) => {
      if ("film" in found) {
        if (found.serial === serial) moving.show(found, state);
        return;
      }
      if (found.loads) {
        if (found.serial === serial) curve = found, showLoad();
        return;
      }
      busy = false;
      if (found.error) {
        note.textContent = `This browser cannot compute the motor: ${found.error}`;
        return;
      }
      state = found;
      if (pending) send();
      show();
      if (busy) return;
      root.classList.remove("trum-busy");
      const most = Math.abs(state.settings.friction_coefficient * state.settings.prepressure * motor.contact_radius);
      post({ values: { ...motor, tolerance: TOLERANCE, ...values }, serial: ++serial, laps: MOST_LAPS,
        count: SAMPLES_PER_PERIOD * state.settings.periods });
      post({ values: { ...motor, ...values, tolerance: 1e-4 }, serial,
        loads: Array.from({ length: LOADS }, (_, i) => i / LOADS * (most || 1)) });
      for (const done of waiting.splice(0)) done(state.figures);
    });
    function send() {
      busy = true;
      pending = false;
      const periods = values.periods ?? 20;
      post({ values: { ...motor, tolerance: TOLERANCE, ...values }, count: SAMPLES_PER_PERIOD * periods });
    }
    function showLoad() {
      drawLoad(root, curve, { load: state.settings.load_torque, speed: state.figures.mean_speed });
    }
    function set(changes) {
      values = { ...values, ...changes };
      remember();
      root.classList.add("trum-busy");
      return new Promise((done) => {
        waiting.push(done);
        if (busy) pending = true;
        else send();
      });
    }
    /* a slider over decades: 0 at its left end, then equal steps of the logarithm */
    function fromSlider(input) {
      const place = Number(input.value), ends = input.dataset.decades?.split(" ").map(Number);
      return !ends ? place : place ? Number((10 ** (ends[0] + (ends[1] - ends[0]) * place / input.max)).toPrecision(3)) : 0;
    }
    function toSlider(input, value) {
      const ends = input.dataset.decades?.split(" ").map(Number);
      return !ends ? value : value > 0 ? input.max * (Math.log10(value) - ends[0]) / (ends[1] - ends[0]) : 0;
    }
    function limit(periods) {
      for (const input of inputs) if (input.dataset.setting === "on_periods") {
        input.min = Math.ceil(periods / 2);
        input.max = periods;
      }
    }
    function show() {
      const { settings, figures } = state;
      if (!busy) limit(settings.periods);
      for (const input of inputs) {
        const wanted = values[input.dataset.setting] ?? settings[input.dataset.setting];
        if (input !== document.activeElement || input.type !== "number") input.value = toSlider(input, wanted);
      }
      for (const cell of root.querySelectorAll("[data-figure]")) {
        const value = figures[cell.dataset.figure];
        cell.textContent = shown(value * (cell.dataset.factor ?? 1));
        cell.dataset.value = String(value);
      }
      note.textContent = (state.field ? state.field.replaceAll("_", " ") + " is out of its range" : figures.status > 0
        ? state.message : "") + (figures.outside_fit ? " The amplitude was measured at other prepressures only." : "");
      draw(root, state, instant);
    }
    function take(input) {
      if (!input.checkValidity() || input.value === "") {
        note.textContent = `${input.dataset.setting.replaceAll("_", " ")}: ${input.validationMessage}`;
        return;
      }
      const name = input.dataset.setting, number = fromSlider(input);
      const value = Number.isNaN(number) ? input.value : number; /* a word, of a choice */
      for (const other of inputs) if (other !== input && other.dataset.setting === name) other.value = toSlider(other, value);
      const changes = { [name]: value };
      if (name === "periods") {
        const on = values.on_periods ?? state.settings.on_periods;
        changes.on_periods = Math.min(Math.max(on, Math.ceil(value / 2)), value);
        limit(value);
      }
      set(changes);
    }
    /* a number counts when it is finished: half-typed ones would drag the others along */
    for (const input of inputs) input.addEventListener(input.type === "range" ? "input" : "change", () => take(input));
    root.querySelector("[data-action=reset]").addEventListener("click", () => { values = {}; set({}); });
    for (const input of instants) input.addEventListener("input", () => {
      if (!input.checkValidity() || input.value === "") return;
      instant = Number(input.value) / 100;
      for (const other of instants) if (other !== input) other.value = input.value;
      if (state) draw(root, state, instant);
      moving.seek(instant);
    });

    /* --- this point elsewhere: the page's address, the console, Python --- */
    const known = new Map(inputs.map((input) => [input.dataset.setting, input]));
    const place = JSON.parse(document.getElementById("trum-motor").textContent);
    function remember() {
      const words = new URLSearchParams(values).toString();
      if (words === location.hash.slice(1) || (!words && !location.hash.includes("="))) return;
      try {
        history.replaceState(null, "", words ? `#${words}` : location.href.split("#")[0]);
      } catch { /* a host that forbids it, or too many changes a minute: the address stays */ }
    }
    function recalled() {
      const found = {};
      for (const [name, word] of new URLSearchParams(location.hash.includes("=") ? location.hash.slice(1) : "")) {
        const input = known.get(name), number = Number(word);
        if (input?.tagName === "SELECT" && [...input.options].some((option) => option.value === word))
          found[name] = Number.isNaN(number) ? word : number;
        else if (input?.type === "number" && word !== "" && number >= Number(input.min) && number <= Number(input.max))
          found[name] = number;
      }
      return found;
    }
    function elsewhere() {
      const sets = { ...place.set }, drive = {}, levels = {};
      for (const [name, value] of Object.entries(values))
        (name in motor ? sets : place.levels.includes(name) ? levels : drive)[name] = value;
      const options = Object.entries({ ...drive, ...levels }).map(([name, value]) => ` --${name.replaceAll("_", "-")} ${value}`);
      const given = Object.entries(sets).map(([name, value]) => ` --set ${name}=${value}`);
      const python = (entries) => Object.entries(entries).map(([name, value]) => `, ${name}=${JSON.stringify(value)}`).join("");
      const changed = Object.keys(sets).length ? `.with_values(${JSON.stringify(sets)})` : "";
      return {
        command: `trum-sym evaluate --motor ${place.motor}${given.join("")}${options.join("")}`,
        python: `import trum_sym as ts\n\nmotor = ts.load_motor("${place.motor}")${changed}\n`
          + `point = ts.evaluate(motor, ts.Drive(${python(drive).slice(2)})${python(levels)})\nprint(point.to_text())\n`,
      };
    }
    for (const button of root.querySelectorAll("[data-copy]")) button.addEventListener("click", async () => {
      const words = elsewhere()[button.dataset.copy], box = root.querySelector(".trum-copied");
      box.textContent = words;
      box.hidden = false;
      const told = root.querySelector(".trum-now");
      try {
        await navigator.clipboard.writeText(words);
        told.textContent = "Copied.";
      } catch { /* the browser does not let it: the words are selected, to be copied by hand */
        getSelection().selectAllChildren(box);
        told.textContent = "Selected: copy it by the keyboard.";
      }
    });
    addEventListener("hashchange", () => { if (location.hash.includes("=")) values = recalled(), set({}); });
    root.querySelector("form").addEventListener("submit", (event) => event.preventDefault());
    let width = 0;
    new ResizeObserver(() => {
      if (state && root.clientWidth !== width) {
        width = root.clientWidth;
        draw(root, state, instant);
        moving.redraw();
        if (curve) showLoad();
      }
    }).observe(root);
    values = recalled();
    window.trumMotor = { ready: set({}), set, moving, elsewhere, settings: () => state.settings, figures: () => state.figures,
      histories: () => state.histories, underLoad: () => curve ?? {}, serial: () => serial };
  }
  begin(document.getElementById("interactive"));
})();

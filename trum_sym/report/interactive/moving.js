"use strict";
/* The moving picture: draws what the compiled kernels have computed, and knows only how to draw.  A film (interactive.js)
 * has the surface's heights, the path of the crest's point and the rotor's speed and way for every sample of a cycle, the
 * rotor's from rest, cycle after cycle. */
window.trumMoving = (root, asked) => {
  const canvas = root.querySelector("[data-moving]"), pen = canvas.getContext("2d");
  const button = (name) => root.querySelector(`[data-action=${name}]`);
  const still = matchMedia("(prefers-reduced-motion: reduce)");
  const ROTOR_MARKS = 9, WAY_DRAWN = 200, SPEED_POINTS = 48;
  let film = null, figures = null, settings = null, colours = null, trace = null;
  let lap = 0, sample = 0, playing = false, until = null, last = 0, frame = 0, drawn = [];

  function paint() {
    const style = getComputedStyle(root), of = (name) => style.getPropertyValue(`--trum-${name}`).trim();
    colours = { ink: of("ink"), soft: of("soft"), line: of("line"), wash: of("wash"), page: of("page"), a: of("a"),
      b: of("b"), touch: of("touch") };
  }
  const perPeriod = () => film.count / settings.periods;
  const laps = () => Math.max(1, film.speeds.length);
  const shown = (x, digits = 3) => !Number.isFinite(x) ? "–" : x === 0 ? "0" : x.toPrecision(digits).replace("-", "−")
    .replace(/e[+]?/, "·10^");
  /* between two samples on the straight line: 48 of them make a period */
  function row(table, length, at) {
    const low = Math.min(Math.floor(at), film.count - 1), share = at - low, found = new Float32Array(length);
    for (let k = 0; k < length; k++)
      found[k] = (1 - share) * table[low * length + k] + share * table[(low + 1) * length + k];
    return found;
  }
  function between(list, at) {
    const low = Math.min(Math.floor(at), film.count - 1);
    return list[low] + (at - low) * (list[low + 1] - list[low]);
  }
  /* of a lap, whose first sample is the end of the one before */
  function rotor(lists, k, at) {
    const list = lists[k];
    if (!list) return NaN;
    const value = (i) => i > 0 ? list[i - 1] : k > 0 && lists === film.speeds ? lists[k - 1][film.count - 1] : 0;
    const low = Math.min(Math.floor(at), film.count - 1);
    return value(low) + (at - low) * (value(low + 1) - value(low));
  }
  function now() {
    const time = sample / film.count * figures.cycle_time, first = figures.region_1, second = figures.region_2;
    return { a: time >= first, b: time < first || time >= second, speed: rotor(film.speeds, lap, sample),
      period: Math.min(settings.periods, Math.floor(sample / perPeriod() + 1e-9) + 1) };
  }
  const words = (value) => value ? "on" : "off";

  /* --- drawing --- */
  function line(xs, ys, length, colour, width = 1.5) {
    pen.beginPath();
    for (let k = 0; k < length; k++) k ? pen.lineTo(xs(k), ys(k)) : pen.moveTo(xs(k), ys(k));
    pen.strokeStyle = colour;
    pen.lineWidth = width;
    pen.stroke();
  }
  function text(words, x, y, colour = colours.soft, align = "left") {
    pen.fillStyle = colour;
    pen.textAlign = align;
    pen.fillText(words, x, y);
  }
  function wave(histories, box, at) {
    const { left, top, width, height } = box, { columns } = film, base = top + 0.62 * height;
    const most = histories.most.W_c || 1, scale = 0.3 * height / most, heights = row(film.heights, columns, sample);
    const X = (k) => left + width * k / (columns - 1), Y = (value) => base - scale * value;
    const level = between(histories.level, sample), rim = Math.max(Y(level), top + 18), perMetre = width / film.length;
    pen.fillStyle = colours.wash; /* the rotor, its friction layer downward to the level */
    pen.fillRect(left, top + 18, width, rim - top - 18);
    pen.strokeStyle = colours.soft;
    pen.lineWidth = 1;
    let way = 0;
    for (let k = 0; k < lap && film.ways[k]; k++) way += film.ways[k][film.count - 1];
    way += rotor(film.ways, lap, sample) || 0;
    const gap = width / ROTOR_MARKS, shift = ((WAY_DRAWN * way * perMetre) % gap + gap) % gap;
    for (let k = 0; k < ROTOR_MARKS; k++) {
      pen.beginPath();
      pen.moveTo(left + k * gap + shift, top + 20);
      pen.lineTo(left + k * gap + shift, top + 32);
      pen.stroke();
    }
    pen.beginPath(); /* the stator */
    pen.moveTo(left, top + height);
    for (let k = 0; k < columns; k++) pen.lineTo(X(k), Y(heights[k]));
    pen.lineTo(left + width, top + height);
    pen.closePath();
    pen.fillStyle = colours.line;
    pen.fill();
    pen.fillStyle = colours.touch; /* where it is above the level it presses into the layer */
    pen.globalAlpha = 0.6;
    const zones = [];
    for (let k = 0, from = -1; k <= columns; k++) {
      const inside = k < columns && heights[k] >= level;
      if (inside && from < 0) from = k;
      if (inside || from < 0) continue;
      pen.beginPath();
      const edge = (i, j) => (i < 0 || j >= columns) ? Math.min(Math.max(i, 0), columns - 1)
        : i + (level - heights[i]) / (heights[j] - heights[i]);
      pen.moveTo(X(edge(from - 1, from)), Y(level));
      for (let i = from; i < k; i++) pen.lineTo(X(i), Y(heights[i]));
      pen.lineTo(X(edge(k - 1, k)), Y(level));
      pen.closePath();
      pen.fill();
      zones.push([X(edge(from - 1, from)), X(edge(k - 1, k))]);
      from = -1;
    }
    pen.globalAlpha = 1;
    line(X, (k) => Y(heights[k]), columns, colours.ink, 1.8);
    line((k) => left + k * width, () => rim, 2, colours.touch, 1);
    for (const zone of zones) line((k) => zone[k], () => rim - 3, 2, colours.touch, 6);
    const crest = between(histories.crest, sample), whole = film.length / 2;
    const first = ((crest % whole) + whole) % whole;
    pen.fillStyle = colours.b;
    for (const x of [first, first + whole]) {
      pen.beginPath();
      pen.arc(left + x * perMetre, Y(between(histories.W_c, sample)), 4, 0, 7);
      pen.fill();
    }
    text("rotor", left + 4, top + 12);
    text(`stator, two wavelengths of ${shown(500 * film.length)} mm; wave ${shown(1e6 * between(histories.W_c, sample))} µm`,
      left + 4, top + height - 6, colours.ink);
    const lamp = (name, on, colour, x) => {
      pen.beginPath();
      pen.arc(x, top + 8, 5, 0, 7);
      pen.fillStyle = on ? colour : colours.page;
      pen.fill();
      pen.strokeStyle = colour;
      pen.lineWidth = 1.5;
      pen.stroke();
      text(`${name} ${words(on)}`, x + 9, top + 12, colours.ink);
    };
    lamp("A", at.a, colours.a, left + width - 124);
    lamp("B", at.b, colours.b, left + width - 62);
  }
  function ellipse(histories, box) {
    const { left, top, width, height } = box, { points } = film;
    const along = row(film.along, points, sample), up = row(film.up, points, sample);
    const reach = 1.1 * Math.max(histories.most.along, histories.most.W_c), scale = Math.min(width, height - 18) / 2 / reach;
    const X = (k) => left + width / 2 + scale * along[k], Y = (k) => top + 18 + (height - 18) / 2 - scale * up[k];
    line((k) => left + k * width, () => top + 18 + (height - 18) / 2, 2, colours.line, 1);
    line(() => left + width / 2, (k) => top + 18 + k * (height - 18), 2, colours.line, 1);
    line(X, Y, points, colours.b, 2);
    pen.beginPath();
    pen.arc(X(points - 1), Y(points - 1), 4, 0, 7);
    pen.fillStyle = colours.ink;
    pen.fill();
    text("path of the crest's point, last period", left, top + 10);
    text(`±${shown(1e6 * reach, 2)} µm`, left + width, top + height - 2, colours.soft, "right");
  }
  function speed(box, at) {
    const { left, top, width, height } = box;
    text(film.speeds.length ? `rotor speed from rest: ${shown(at.speed)} rad/s, cycle ${lap + 1} of ${laps()}`
      : "the rotor's motion does not follow", left, top + 10);
    if (!film.speeds.length) return;
    const { low, high, every, points } = trace, floor = top + height - 24, roof = top + 20;
    const X = (cycles) => left + 34 + (width - 34) * cycles / laps();
    const Y = (value) => floor - (floor - roof) * (value - low) / (high - low || 1);
    for (const value of [low, 0, high]) {
      line((k) => left + 34 + k * (width - 34), () => Y(value), 2, colours.line, 1);
      text(shown(value, 2), left + 30, Y(value) + 4, colours.soft, "right");
    }
    pen.setLineDash([5, 4]);
    line((k) => left + 34 + k * (width - 34), () => Y(figures.mean_speed), 2, colours.b, 1.2);
    pen.setLineDash([]);
    line((k) => X(k / every), (k) => Y(points[k]), points.length, colours.line, 1);
    const done = Math.floor((lap + sample / film.count) * every) + 1;
    line((k) => X(k / every), (k) => Y(points[k]), Math.min(done, points.length), colours.ink, 1.4);
    pen.beginPath();
    pen.arc(X(lap + sample / film.count), Y(at.speed), 4, 0, 7);
    pen.fillStyle = colours.ink;
    pen.fill();
    text(`0 to ${laps()} cycles; dashed: the mean it comes to`, left + 34, top + height - 2);
  }
  function draw(histories) {
    const begin = performance.now(), ratio = Math.min(devicePixelRatio || 1, 2);
    const width = canvas.clientWidth, narrow = width < 560, height = narrow ? 560 : 400;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
      canvas.style.height = `${height}px`;
    }
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.font = "12px system-ui, sans-serif";
    pen.lineJoin = "round";
    if (!film?.film) {
      text("nothing moves here", 8, 20);
      return;
    }
    const at = now(), upper = 200;
    wave(histories, { left: 0, top: 0, width, height: upper }, at);
    if (narrow) {
      ellipse(histories, { left: 8, top: upper + 10, width: width - 16, height: 160 });
      speed({ left: 0, top: upper + 185, width, height: height - upper - 190 }, at);
    } else {
      const side = Math.min(230, width / 3);
      ellipse(histories, { left: 8, top: upper + 12, width: side, height: height - upper - 16 });
      speed({ left: side + 36, top: upper + 12, width: width - side - 40, height: height - upper - 16 }, at);
    }
    drawn.push(performance.now() - begin);
  }

  /* --- playing --- */
  let histories = null;
  function said() {
    if (!film?.film) return "Nothing moves at this drive.";
    const at = now();
    return `Cycle ${lap + 1} of ${laps()} from rest, period ${at.period} of ${settings.periods}: phase A ${words(at.a)}, `
      + `phase B ${words(at.b)}; the wave is ${shown(1e6 * between(histories.W_c, sample))} micrometres high and touches over `
      + `plus and minus ${shown(between(histories.theta, sample) * 180 / Math.PI)} degrees; `
      + (Number.isFinite(at.speed) ? `the rotor turns at ${shown(at.speed)} radians per second.` : "the rotor's motion does not follow.");
  }
  function rest() { /* at a stop: the words, and the other pictures' instant */
    canvas.setAttribute("aria-label", said());
    root.querySelector(".trum-now").textContent = said();
    if (film?.film) asked(sample / film.count);
  }
  function label() {
    button("play").textContent = playing && until === null ? "Pause" : "Play";
  }
  function stop() {
    playing = false;
    until = null;
    cancelAnimationFrame(frame);
    label();
    rest();
  }
  function advance(samples) {
    sample += samples;
    for (; sample >= film.count; sample -= film.count) if (lap + 1 < laps()) lap++;
  }
  function tick(time) {
    if (!playing) return;
    const pace = Number(root.querySelector("[data-pace]").value) * perPeriod();
    const step = Math.min(0.1, (time - last) / 1000) * pace;
    last = time;
    if (until !== null && step >= until) {
      advance(until);
      sample = Math.round(sample);
      draw(histories);
      return stop();
    }
    if (until !== null) until -= step;
    advance(step);
    draw(histories);
    frame = requestAnimationFrame(tick);
  }
  function play(samples = null) {
    if (!film?.film) return;
    cancelAnimationFrame(frame);
    if (samples !== null && still.matches) { /* no motion: at once */
      advance(samples);
      sample = Math.round(sample);
      draw(histories);
      return stop();
    }
    playing = true;
    until = samples;
    last = performance.now();
    label();
    frame = requestAnimationFrame(tick);
  }
  button("play").addEventListener("click", () => playing && until === null ? stop() : play());
  button("period").addEventListener("click", () => { if (film?.film) play(perPeriod() - sample % perPeriod() || perPeriod()); });
  button("rest").addEventListener("click", () => {
    lap = sample = 0;
    if (film) draw(histories);
    if (!playing) rest();
  });
  const repaint = () => { paint(); if (film) draw(histories); };
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", repaint);
  new MutationObserver(repaint).observe(document.documentElement, { attributeFilter: ["data-theme"] });
  paint();

  return {
    show(found, state) { /* a film of this state; the rotor is shown at its last cycle until it is played from rest */
      const first = !film?.film;
      film = found;
      ({ figures, settings, histories } = state);
      const large = (list) => list.reduce((most, value) => Math.max(most, Math.abs(value) || 0), 0);
      histories.most = { W_c: large(histories.W_c), along: film.film ? large(film.along) : 1 };
      const every = SPEED_POINTS, points = [0];
      for (let k = 0; k < film.speeds.length; k++)
        for (let i = 1; i <= every; i++) points.push(rotor(film.speeds, k, film.count * i / every));
      trace = { every, points, low: Math.min(0, ...points), high: Math.max(0, ...points) };
      if (first) sample = Math.round(0.6 * film.count), lap = laps() - 1;
      lap = Math.min(lap, laps() - 1);
      sample = Math.min(sample, film.count - 1);
      draw(histories);
      if (!playing) rest();
    },
    seek(instant) { /* within the cycle that is shown */
      if (!film?.film) return;
      sample = Math.min(instant * film.count, film.count - 1e-6);
      draw(histories);
      if (!playing) canvas.setAttribute("aria-label", said());
    },
    redraw: () => { if (film) draw(histories); },
    play, stop, playing: () => playing, place: () => ({ lap, sample }), film: () => film,
    times: () => { const found = drawn; drawn = []; return found; },
  };
};

// The table, the curve and the time line on their canvases.

const NONE = 0, COMING = 1, UNDER_WAY = 2, OVER = 3;
const COLOURS = @COLOURS@;
const TOOL_M = 0.01;

function colourOf(link) { return COLOURS[(link.n - 1 + 10 * COLOURS.length) % COLOURS.length]; }

function theme(name) {
  return getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
}

// The context of a canvas in CSS pixels, cleared.
function begin(canvas) {
  const ratio = window.devicePixelRatio || 1;
  const width = canvas.clientWidth, height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const g = canvas.getContext("2d");
  g.setTransform(ratio, 0, 0, ratio, 0, 0);
  g.clearRect(0, 0, width, height);
  g.font = "12px system-ui, 'DejaVu Sans', sans-serif";
  g.setLineDash([]);
  g.globalAlpha = 1;
  return [g, width, height];
}

// 1, 2 or 5 times a power of ten, for about `n` steps in a span.
function tick(span, n) {
  const rough = span / n, power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map((k) => k * power).find((step) => step >= rough);
}

// The middle and the size of where nearly all of the points lie that `wanted` takes.
function around(run, frames, wanted) {
  const xs = [], ys = [], every = Math.max(1, Math.floor(frames.length / 60));
  for (let f = frames.length - 1; f >= 0; f -= every) {
    const frame = frames[f], model = run.models[frame.model];
    for (let i = 0; i < frame.ids.length; i++) {
      if (!wanted(model, frame.ids[i])) continue;
      xs.push(frame.x[i]);
      ys.push(frame.y[i]);
    }
  }
  if (!xs.length) return null;
  const range = (values) => {
    values.sort((a, b) => a - b);
    const at = (q) => values[Math.round(q * (values.length - 1))] * run.length_m;
    return [at(0.002), at(0.998)];
  };
  const [x0, x1] = range(xs), [y0, y1] = range(ys);
  return { x: (x0 + x1) / 2, y: (y0 + y1) / 2, w: x1 - x0, h: y1 - y0 };
}

// What is shown of a trial: the object with some room, or the whole table.
function extent(run, trial, table) {
  const frames = run.frames.filter((frame) => frame.trial === trial);
  const part = table ? null : around(run, frames, (model, id) => model && model.linkOf.get(id) >= 0);
  const v = part || around(run, frames, () => true) || { x: 0, y: 0, w: 2, h: 1.6 };
  const room = Math.max(part ? 0.12 : 0.04, 0.05 * Math.max(v.w, v.h));
  return { x: v.x, y: v.y, w: v.w + 2 * room, h: v.h + 2 * room };
}

const MARGIN = { left: 46, right: 12, top: 12, bottom: 34 };

// From metres to pixels: v is the middle of the picture and its width and height in metres.
function projection(v, width, height) {
  const w = width - MARGIN.left - MARGIN.right, h = height - MARGIN.top - MARGIN.bottom;
  const scale = Math.max(Math.min(w / v.w, h / v.h), 1e-3);
  const cx = MARGIN.left + w / 2, cy = MARGIN.top + h / 2;
  return { scale, x: (x) => cx + (x - v.x) * scale, y: (y) => cy - (y - v.y) * scale,
    backX: (px) => (px - cx) / scale + v.x, backY: (py) => v.y - (py - cy) / scale };
}

// Where a point of a link of the model is in a frame.
function moved(run, frame, link, x, y) {
  if (frame.motion.length < 3 * link + 3) return [x, y, 0];
  const angle = frame.motion[3 * link + 2] * run.angle_rad;
  const c = Math.cos(angle), s = Math.sin(angle);
  return [c * x - s * y + frame.motion[3 * link] * run.length_m,
    s * x + c * y + frame.motion[3 * link + 1] * run.length_m, angle];
}

function text(g, string, x, y, colour) {
  g.lineWidth = 3;
  g.lineJoin = "round";
  g.strokeStyle = theme("panel");
  g.strokeText(string, x, y);
  g.fillStyle = colour;
  g.fillText(string, x, y);
}

function drawAxes(g, p, width, height) {
  const right = width - MARGIN.right, bottom = height - MARGIN.bottom;
  const span = p.backX(right) - p.backX(MARGIN.left), step = tick(span, width / 110);
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  g.strokeStyle = theme("line");
  g.fillStyle = theme("soft");
  g.lineWidth = 1;
  g.beginPath();
  g.textAlign = "center";
  g.textBaseline = "top";
  for (let x = Math.ceil(p.backX(MARGIN.left) / step) * step; x <= p.backX(right); x += step) {
    g.moveTo(p.x(x), MARGIN.top);
    g.lineTo(p.x(x), bottom);
    g.fillText((Math.abs(x) < step / 2 ? 0 : x).toFixed(digits), p.x(x), bottom + 4);
  }
  g.textAlign = "right";
  g.textBaseline = "middle";
  for (let y = Math.ceil(p.backY(bottom) / step) * step; y <= p.backY(MARGIN.top); y += step) {
    g.moveTo(MARGIN.left, p.y(y));
    g.lineTo(right, p.y(y));
    g.fillText((Math.abs(y) < step / 2 ? 0 : y).toFixed(digits), MARGIN.left - 5, p.y(y));
  }
  g.stroke();
  g.textAlign = "center";
  g.fillText("x (m)", (MARGIN.left + right) / 2, height - 9);
  g.save();
  g.translate(11, (MARGIN.top + bottom) / 2);
  g.rotate(-Math.PI / 2);
  g.fillText("y (m)", 0, 0);
  g.restore();
}

function outline(g, p, x, y, angle, length, width, round) {
  g.save();
  g.translate(p.x(x), p.y(y));
  g.rotate(-angle);
  g.beginPath();
  const w = length * p.scale, h = width * p.scale;
  g.roundRect(-w / 2, -h / 2, w, h, Math.min(round * p.scale, h / 2));
  g.restore();
}

function drawLinks(g, p, run, frame, model) {
  model.links.forEach((link, i) => {
    const [x, y, turn] = moved(run, frame, i, link.x, link.y);
    outline(g, p, x, y, link.angle + turn, link.length + 0.02, link.width + 0.02, 0.012);
    g.fillStyle = g.strokeStyle = colourOf(link);
    g.globalAlpha = 0.13;
    g.fill();
    g.globalAlpha = 0.45;
    g.lineWidth = 1;
    g.stroke();
    g.globalAlpha = 1;
  });
}

function drawPoints(g, p, run, frame, model) {
  const still = theme("still"), radius = Math.min(Math.max(0.004 * p.scale, 2.5), 6);
  for (let i = 0; i < frame.ids.length; i++) {
    const known = model && model.linkOf.get(frame.ids[i]);
    const link = known !== undefined && known >= 0 ? model.links[known] : null;
    g.beginPath();
    g.arc(p.x(frame.x[i] * run.length_m), p.y(frame.y[i] * run.length_m), link ? radius : radius * 0.75,
      0, 2 * Math.PI);
    if (link || known === -1) {
      g.fillStyle = link ? colourOf(link) : still;
      g.fill();
    } else {
      g.strokeStyle = still;
      g.lineWidth = 1.2;
      g.stroke();
    }
  }
}

function drawJoint(g, p, run, frame, model, joint) {
  const [x, y, turn] = moved(run, frame, joint.a, joint.x, joint.y);
  const ink = theme("ink"), px = p.x(x), py = p.y(y);
  g.globalAlpha = 0.35 + 0.65 * joint.p;
  g.strokeStyle = ink;
  g.lineWidth = 2;
  g.beginPath();
  if (joint.type === "revolute") {
    g.arc(px, py, 6, 0, 2 * Math.PI);
    g.fillStyle = theme("panel");
    g.fill();
    g.moveTo(px - 10, py);
    g.lineTo(px + 10, py);
    g.moveTo(px, py - 10);
    g.lineTo(px, py + 10);
  } else {
    const a = model.links[joint.a], b = model.links[joint.b];
    const reach = 0.6 * (a.length + b.length), angle = joint.angle + turn;
    g.setLineDash([7, 5]);
    g.moveTo(p.x(x - reach * Math.cos(angle)), p.y(y - reach * Math.sin(angle)));
    g.lineTo(p.x(x + reach * Math.cos(angle)), p.y(y + reach * Math.sin(angle)));
  }
  g.stroke();
  g.setLineDash([]);
  g.globalAlpha = 1;
  const side = model.links[joint.a].angle + turn - Math.PI / 2, away = 24;
  text(g, joint.p.toFixed(2), px + away * Math.cos(side), py - away * Math.sin(side), ink);
}

function drawNames(g, p, run, frame, model) {
  g.font = "600 13px system-ui, 'DejaVu Sans', sans-serif";
  model.links.forEach((link, i) => {
    const [x, y, turn] = moved(run, frame, i, link.x, link.y);
    const side = link.angle + turn + Math.PI / 2, away = link.width / 2 + 0.025;
    text(g, "f" + link.n, p.x(x + away * Math.cos(side)), p.y(y + away * Math.sin(side)), colourOf(link));
  });
  g.font = "12px system-ui, 'DejaVu Sans', sans-serif";
}

function drawPush(g, p, push, stage) {
  if (!push || !push.start || stage === NONE) return;
  const x0 = p.x(push.start[0]), y0 = p.y(push.start[1]);
  const x1 = p.x(push.end[0]), y1 = p.y(push.end[1]);
  const angle = Math.atan2(y1 - y0, x1 - x0);
  g.strokeStyle = g.fillStyle = theme("push");
  g.globalAlpha = stage === OVER ? 0.25 : 1;
  g.lineWidth = stage === UNDER_WAY ? 3.5 : 2.5;
  g.setLineDash(stage === COMING ? [9, 5] : []);
  g.beginPath();
  g.moveTo(x0, y0);
  g.lineTo(x1 - 8 * Math.cos(angle), y1 - 8 * Math.sin(angle));
  g.stroke();
  g.setLineDash([]);
  g.beginPath();
  g.arc(x0, y0, Math.max(TOOL_M * p.scale, 3), 0, 2 * Math.PI);
  g.stroke();
  g.beginPath();
  g.moveTo(x1, y1);
  g.lineTo(x1 - 14 * Math.cos(angle - 0.4), y1 - 14 * Math.sin(angle - 0.4));
  g.lineTo(x1 - 14 * Math.cos(angle + 0.4), y1 - 14 * Math.sin(angle + 0.4));
  g.fill();
  g.globalAlpha = 1;
}

function drawTruth(g, p, run, frame) {
  g.strokeStyle = theme("truth");
  g.lineWidth = 1.5;
  g.setLineDash([5, 3]);
  run.truth.sizes.forEach(([length, width], i) => {
    outline(g, p, frame.truth[3 * i] * run.length_m, frame.truth[3 * i + 1] * run.length_m,
      frame.truth[3 * i + 2] * run.angle_rad, length, width, 0);
    g.stroke();
  });
  g.setLineDash([]);
}

// Returns the projection, for the mouse.
function drawTable(canvas, run, frame, view, withTruth) {
  const [g, width, height] = begin(canvas);
  const p = projection(view, width, height);
  drawAxes(g, p, width, height);
  if (!frame) return p;
  g.save();
  g.beginPath();
  g.rect(MARGIN.left, MARGIN.top, width - MARGIN.left - MARGIN.right, height - MARGIN.top - MARGIN.bottom);
  g.clip();
  g.textAlign = "center";
  g.textBaseline = "middle";
  const model = run.models[frame.model];
  if (model) drawLinks(g, p, run, frame, model);
  drawPoints(g, p, run, frame, model);
  if (withTruth && frame.truth) drawTruth(g, p, run, frame);
  drawPush(g, p, run.pushes[frame.push], frame.stage);
  if (model) {
    for (const joint of model.joints) drawJoint(g, p, run, frame, model, joint);
    drawNames(g, p, run, frame, model);
  }
  g.restore();
  return p;
}

// --- the curve

function drawCurve(canvas, run, current) {
  const [g, width, height] = begin(canvas);
  const trials = run.trials.map((trial, i) => ({ ...trial, index: i }))
    .filter((trial) => trial.id > 0 && trial.outcome !== "aborted");
  const most = Math.max(5, ...trials.map((trial) => trial.pushes));
  const left = 34, bottom = height - 30, right = width - 8, top = 8;
  const x = (i) => left + (trials.length < 2 ? 0.5 : i / (trials.length - 1)) * (right - left);
  const y = (n) => bottom - n / most * (bottom - top);
  g.fillStyle = theme("soft");
  g.strokeStyle = theme("line");
  g.textAlign = "right";
  g.textBaseline = "middle";
  const step = Math.max(1, tick(most, 4));
  for (let n = 0; n <= most; n += step) {
    g.fillText(n, left - 6, y(n));
    g.beginPath();
    g.moveTo(left, y(n));
    g.lineTo(right, y(n));
    g.stroke();
  }
  g.textAlign = "center";
  if (trials.length) {
    const every = Math.max(1, Math.round(tick(trials.length, 6)));
    trials.forEach((trial, i) => {
      if (i === 0 || trial.id % every === 0) g.fillText(trial.id, x(i), bottom + 11);
    });
  }
  g.fillText("trial", (left + right) / 2, height - 6);
  const done = trials.filter((trial) => trial.outcome);
  g.strokeStyle = theme("accent");
  g.lineWidth = 2;
  g.beginPath();
  for (let i = 4; i < done.length; i++) {
    const mean = done.slice(i - 4, i + 1).reduce((sum, trial) => sum + trial.pushes, 0) / 5;
    g.lineTo(x(trials.indexOf(done[i])), y(mean));
  }
  g.stroke();
  trials.forEach((trial, i) => {
    g.beginPath();
    g.arc(x(i), y(trial.pushes), trial.index === current ? 5 : 2.5, 0, 2 * Math.PI);
    g.fillStyle = g.strokeStyle = trial.index === current ? theme("ink") : theme("accent");
    if (trial.outcome === "capped" || !trial.outcome) g.stroke();
    else g.fill();
  });
}

// --- the time line

function drawTime(canvas, run, at) {
  const [g, width, height] = begin(canvas);
  const frames = run.frames, end = frames.length ? Math.max(frames[frames.length - 1].t, 1e-6) : 1;
  const from = frames.length ? frames[0].t : 0;
  const x = (t) => 8 + (t - from) / Math.max(end - from, 1e-6) * (width - 16);
  const marks = []; // where trials and pushes begin
  frames.forEach((frame, f) => {
    const before = frames[f - 1];
    if (!before || before.trial !== frame.trial) marks.push({ t: frame.t, trial: frame.trial });
    if (frame.push >= 0 && (!before || before.push !== frame.push)) marks.push({ t: frame.t, trial: -1 });
  });
  const trials = marks.filter((mark) => mark.trial >= 0);
  g.fillStyle = theme("line");
  trials.forEach((mark, i) => {
    const to = i + 1 < trials.length ? trials[i + 1].t : end;
    if (i % 2 === 0) g.fillRect(x(mark.t), 6, x(to) - x(mark.t), height - 20);
  });
  g.fillStyle = theme("accent");
  for (const mark of marks) if (mark.trial < 0) g.fillRect(x(mark.t) - 0.5, height - 24, 1, 9);
  g.fillStyle = theme("soft");
  g.textAlign = "left";
  g.textBaseline = "bottom";
  let free = 0;
  for (const mark of trials) {
    const id = run.trials[mark.trial].id;
    if (x(mark.t) < free || id === 0) continue;
    g.fillText(id, x(mark.t), height);
    free = x(mark.t) + 26;
  }
  g.fillStyle = theme("ink");
  g.fillRect(x(at) - 1, 2, 2, height - 14);
  return (px) => from + (px - 8) / (width - 16) * (end - from);
}

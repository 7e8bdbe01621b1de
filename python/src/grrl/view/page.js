// The page: what is shown now, the keys, the news of a live run.

const SPEEDS = [0.25, 0.5, 1, 2, 4, 8, 16];
const element = (id) => document.getElementById(id);
const state = { run: null, at: 0, t: 0, playing: false, speed: 1, follow: false, truth: true,
  view: null, viewOf: "", table: false, projection: null, timeOf: null, lost: false };

function make(tag, className, string) {
  const node = document.createElement(tag);
  if (className) node.className = className;
  if (string !== undefined) node.textContent = string;
  return node;
}

function put(id, string) {
  if (element(id).textContent !== string) element(id).textContent = string;
}

// --- texts

const number = (x, digits) => x.toFixed(digits).replace(/^-(?=[0.]*[1-9])/, "\u2212").replace("-", "");

function excursion(joint) {
  if (joint.type === "revolute") {
    const degrees = (x) => number(x * 180 / Math.PI, 0);
    return `${degrees(joint.lower)}\u00b0 to ${degrees(joint.upper)}\u00b0`;
  }
  return `${number(1000 * joint.lower, 0)} to ${number(1000 * joint.upper, 0)} mm`;
}

function showPush(run, frame) {
  const push = frame && run.pushes[frame.push];
  const titles = ["No push yet", "Next push", "Push under way", "Last push"];
  put("push-title", push ? `${titles[frame.stage]} (${push.cmd} of this trial)` : titles[0]);
  const what = element("push-what");
  const link = push && run.models[frame.model]?.links.find((l) => l.n === push.link);
  what.style.color = link ? colourOf(link) : "";
  put("push-what", push && push.link ? `f${push.link} at ${push.direction}\u00b0` : "");
  put("push-why", push ? push.why : "");
  const how = [];
  if (push && push.start)
    how.push(`${push.speed.toFixed(2)} m/s, ${push.force.toFixed(0)} N at most, ` +
      `${(1000 * push.travel).toFixed(0)} mm after contact`);
  if (push && push.phi !== null && push.phi !== undefined) how.push(`phi\u00a0${push.phi.toFixed(2)}`);
  if (push && frame.stage === OVER && push.result) how.push(push.result);
  if (push && frame.stage === OVER && push.reward !== null) how.push(`reward ${push.reward}`);
  put("push-how", how.join("; "));
}

function showJoints(model) {
  const key = model ? `${state.run.models.indexOf(model)}` : "";
  const list = element("joints");
  if (list.dataset.key === key && !state.run.live) return;
  list.dataset.key = key;
  list.replaceChildren();
  for (const joint of model ? model.joints : []) {
    const row = make("li");
    const ends = make("span");
    for (const i of [joint.a, joint.b]) {
      const dot = make("span", "swatch");
      dot.style.background = colourOf(model.links[i]);
      ends.append(dot, `f${model.links[i].n} `);
    }
    row.append(ends, make("span", "", joint.type), make("span", "", joint.p.toFixed(3)),
      make("span", "small", excursion(joint)));
    list.append(row);
  }
  if (!list.children.length) list.append(make("li", "small", "none yet"));
}

function showLegend(model) {
  const legend = element("legend");
  const links = model ? model.links : [];
  const key = links.map((l) => l.n).join() + state.truth;
  if (legend.dataset.key === key) return;
  legend.dataset.key = key;
  legend.replaceChildren();
  const add = (mark, string, className) => {
    const item = make("span", className);
    item.append(mark, string);
    legend.append(item);
  };
  for (const link of links) {
    const dot = make("span", "swatch");
    dot.style.background = colourOf(link);
    add(dot, `f${link.n}`);
  }
  const still = make("span", "swatch");
  still.style.background = theme("still");
  add(still, "table");
  add(make("span", "swatch open"), "link unknown");
  add(make("span", "mark", "\u2295"), "pivot with its probability");
  add(make("span", "mark", "\u2504"), "sliding axis");
  add(make("span", "mark", "\u2192"), "push (dashed: to come)");
  if (state.run.truth && state.truth) add("\u25ad ", "truth of the simulator", "truth");
}

function showWhere(run, frame) {
  const trial = frame && run.trials[frame.trial];
  if (!trial) return put("where", "");
  const last = run.trials[run.trials.length - 1];
  const name = !trial.id ? "no supervisor" : run.live ? `trial ${trial.id}`
    : `trial ${trial.id} of ${last.id}`;
  const over = frame === lastOf(run, frame.trial) ? trial.outcome : "";
  const push = run.pushes[frame.push];
  const pushes = push ? `push ${push.cmd}` : "before the first push";
  put("where", [name, pushes, over].filter(Boolean).join(", "));
}

function lastOf(run, trial) {
  for (let f = run.frames.length - 1; f >= 0; f--) if (run.frames[f].trial === trial) return run.frames[f];
  return null;
}

function notice(run) {
  const info = run.info, lines = [...info.warnings];
  if (state.lost) lines.push("grrl-view has ended; what it sent is still here");
  if (info.over) lines.push(info.over);
  if (info.stopped) lines.push(`GRRL_STOP was heard: ${info.stopped}`);
  if (run.live && !run.frames.length && info.heard)
    lines.push(`heard ${info.channels.join(", ")} but no points_t on GRRL_POINTS`);
  else if (run.live && !state.lost && !info.over && info.silent_s > 2)
    lines.push(info.heard ? `nothing heard for ${info.silent_s.toFixed(0)} s`
      : `nothing heard on ${run.title} yet: is a tracker or grrl-sim running there?`);
  element("notice").hidden = !lines.length;
  put("notice", lines.join("\n"));
}

// --- one picture

// A view for each trial, until the mouse chooses another. In a live run it follows what grows.
function aim(run, frame) {
  const trial = frame ? frame.trial : -1, known = run.live ? run.models.length : 0;
  const name = [trial, state.table, known].join();
  if (state.viewOf === "mouse" + trial || state.viewOf === name) return;
  state.viewOf = name;
  state.view = extent(run, trial, state.table);
}

function show() {
  const run = state.run;
  if (!run) return;
  const frame = run.frames[state.at], model = frame && run.models[frame.model];
  aim(run, frame);
  state.projection = drawTable(element("table"), run, frame, state.view, state.truth);
  state.timeOf = drawTime(element("time"), run, state.t);
  drawCurve(element("curve"), run, frame ? frame.trial : -1);
  element("table").setAttribute("aria-label", frame ? `${frame.ids.length} points, ` +
    `${model ? model.links.length : 0} links, ${model ? model.joints.length : 0} joints` : "no points yet");
  put("term", model ? model.term : "nothing yet");
  showPush(run, frame);
  showJoints(model);
  showLegend(model);
  showWhere(run, frame);
  notice(run);
  const end = run.frames.length ? run.frames[run.frames.length - 1].t : 0;
  put("clock", `${state.t.toFixed(1)} of ${end.toFixed(1)} s`);
  put("play", state.playing ? "Pause" : "Play");
  put("curve-title", run.trials.some((t) => t.id > 0) ? "Pushes a trial (line: mean of five)"
    : "Pushes a trial: there is no supervisor");
  element("live").hidden = element("follow").hidden = !run.live;
  element("live").className = state.follow ? "" : "paused";
  put("live", state.lost ? "ended" : state.follow ? "live" : "paused");
  element("truth-mark").hidden = !(run.truth && state.truth);
  element("show-truth").hidden = !run.truth;
  document.body.dataset.frames = run.frames.length;
  document.body.dataset.at = state.at;
}

// --- moving in time

function seek(index) {
  const frames = state.run.frames;
  state.at = Math.min(Math.max(index, 0), Math.max(frames.length - 1, 0));
  state.t = frames.length ? frames[state.at].t : 0;
  state.follow = false;
  show();
}

function indexAt(t) {
  const frames = state.run.frames;
  let low = 0, high = frames.length;
  while (high - low > 1) {
    const middle = low + high >> 1;
    if (frames[middle].t <= t) low = middle;
    else high = middle;
  }
  return low;
}

// The frame in which a push is about to come, from push to push; or where a trial begins.
function step(direction, wanted) {
  const frames = state.run.frames;
  for (let f = state.at + direction; f >= 0 && f < frames.length; f += direction)
    if (wanted(frames[f], frames[f - 1], frames[f + 1])) return seek(f);
  return seek(direction > 0 ? frames.length - 1 : 0);
}

const decides = (frame, before, after) => frame.stage === COMING && (!after || after.stage !== COMING);
const begins = (frame, before) => !before || before.trial !== frame.trial;

function play(on) {
  state.playing = on;
  if (on) {
    state.follow = false;
    if (state.at >= state.run.frames.length - 1) seek(0);
    let before = performance.now();
    const turn = (now) => {
      if (!state.playing) return;
      state.t += (now - before) / 1000 * state.speed;
      before = now;
      state.at = indexAt(state.t);
      if (state.at >= state.run.frames.length - 1) {
        state.playing = false;
        state.t = state.run.frames[state.at].t;
      }
      show();
      requestAnimationFrame(turn);
    };
    requestAnimationFrame(turn);
  }
  show();
}

function follow() {
  state.playing = false;
  seek(state.run.frames.length - 1);
  state.follow = true;
  show();
}

function faster(by) {
  const i = Math.min(Math.max(SPEEDS.indexOf(state.speed) + by, 0), SPEEDS.length - 1);
  state.speed = SPEEDS[i];
  element("speed").value = state.speed;
}

function toggleTruth() {
  state.truth = !state.truth;
  show();
}

function whole() {
  if (!state.viewOf.startsWith("mouse")) state.table = !state.table;
  state.viewOf = "";
  show();
}

function byMouse() {
  const frame = state.run.frames[state.at];
  state.viewOf = "mouse" + (frame ? frame.trial : -1);
}

// --- keys and mouse

function key(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "SELECT") return;
  const push = event.shiftKey;
  const actions = {
    " ": () => play(!state.playing),
    ArrowLeft: () => push ? step(-1, decides) : seek(state.at - 1),
    ArrowRight: () => push ? step(1, decides) : seek(state.at + 1),
    PageUp: () => step(-1, begins), PageDown: () => step(1, begins),
    Home: () => seek(0), End: () => seek(state.run.frames.length - 1),
    "+": () => faster(1), "-": () => faster(-1), "0": whole,
    l: () => state.run.live && follow(), t: () => state.run.truth && toggleTruth(),
  };
  const action = actions[event.key] || actions[event.key.toLowerCase()];
  if (!action || !state.run) return;
  event.preventDefault();
  if (event.key.startsWith("Arrow") || event.key.startsWith("Page")) state.playing = false;
  action();
}

function zoom(event) {
  event.preventDefault();
  const p = state.projection, v = state.view, k = Math.exp(Math.sign(event.deltaY) * 0.15);
  const x = p.backX(event.offsetX), y = p.backY(event.offsetY);
  state.view = { x: x + (v.x - x) * k, y: y + (v.y - y) * k, w: v.w * k, h: v.h * k };
  byMouse();
  show();
}

function drag(canvas, move) {
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    move(event, true);
  });
  canvas.addEventListener("pointermove", (event) => event.buttons & 1 && move(event, false));
}

function listen() {
  document.addEventListener("keydown", key);
  window.addEventListener("resize", show);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    element("legend").dataset.key = "-";
    show();
  });
  element("play").onclick = () => play(!state.playing);
  element("previous").onclick = () => step(-1, decides);
  element("next").onclick = () => step(1, decides);
  element("follow").onclick = follow;
  element("show-truth").onclick = toggleTruth;
  for (const speed of SPEEDS) element("speed").append(new Option(`${speed}\u00d7`, speed));
  element("speed").value = state.speed;
  element("speed").onchange = () => { state.speed = Number(element("speed").value); };
  for (const button of document.querySelectorAll("button"))
    button.addEventListener("click", () => button.blur()); // the space bar plays
  element("table").addEventListener("wheel", zoom, { passive: false });
  element("table").addEventListener("dblclick", whole);
  drag(element("table"), (event, first) => {
    if (first || !state.view) return;
    const s = state.projection.scale;
    state.view = { ...state.view, x: state.view.x - event.movementX / s,
      y: state.view.y + event.movementY / s };
    byMouse();
    show();
  });
  drag(element("time"), (event) => {
    state.playing = false;
    seek(indexAt(state.timeOf(event.offsetX)));
  });
}

// --- where the run comes from

function take(run) {
  const first = !state.run;
  state.run = run;
  put("title", run.title);
  if (run.truth)
    put("truth-mark", `with the truth of the simulator: ${run.truth.object}, seed ${run.truth.seed}`);
  if (first) {
    state.follow = run.live;
    const decided = run.frames.findIndex((f, i) => decides(f, null, run.frames[i + 1]));
    state.at = run.live ? run.frames.length - 1 : Math.max(decided, 0);
  }
  state.at = Math.min(Math.max(state.at, 0), Math.max(run.frames.length - 1, 0));
  state.t = run.frames.length ? run.frames[state.at].t : 0;
  show();
  document.body.dataset.ready = "1";
}

let due = false;
function soon() {
  if (due) return;
  due = true;
  requestAnimationFrame(() => {
    due = false;
    if (state.follow && state.run.frames.length) {
      state.at = state.run.frames.length - 1;
      state.t = state.run.frames[state.at].t;
    }
    show();
  });
}

function connect() {
  const socket = new WebSocket(`ws://${location.host}/live`);
  let turn = Promise.resolve(); // in the order they came
  socket.binaryType = "arraybuffer";
  socket.onmessage = (message) => {
    turn = turn.then(async () => {
      if (typeof message.data !== "string") take(await unpack(new Uint8Array(message.data)));
      else apply(state.run, JSON.parse(message.data));
      state.lost = false;
      soon();
    });
  };
  socket.onclose = () => {
    state.lost = true;
    soon();
    setTimeout(connect, 1000);
  };
}

async function start() {
  listen();
  const data = withinPage() || new Uint8Array(await (await fetch("data")).arrayBuffer());
  take(await unpack(data));
  if (state.run.live) connect();
}

start().catch((error) => {
  element("notice").hidden = false;
  put("notice", `this page cannot show the run: ${error.message}`);
});

// The run as the server or the file gives it; see pack.py.

async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// All numbers of a column: four planes of bytes, the sign in the lowest bit.
function column(bytes, at, n) {
  const values = new Int32Array(n);
  for (let i = 0; i < n; i++) {
    const v = bytes[at + i] | bytes[at + n + i] << 8 | bytes[at + 2 * n + i] << 16
      | bytes[at + 3 * n + i] << 24;
    values[i] = v >>> 1 ^ -(v & 1);
  }
  return values;
}

// Rows of lengths[f], each less the row before where that is as long.
function rows(values, lengths) {
  const out = [];
  let at = 0;
  for (let f = 0; f < lengths.length; f++) {
    const row = values.subarray(at, at + lengths[f]);
    at += lengths[f];
    if (f > 0 && lengths[f - 1] === lengths[f]) {
      const before = out[f - 1];
      for (let i = 0; i < row.length; i++) row[i] += before[i];
    }
    out.push(row);
  }
  return out;
}

async function unpack(compressed) {
  const bytes = await inflate(compressed);
  const n = new DataView(bytes.buffer).getUint32(0, true);
  const run = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + n)));
  const columns = {};
  let at = 4 + n;
  for (const [name, size] of run.columns) {
    columns[name] = column(bytes, at, size);
    at += 4 * size;
  }
  for (const name of ["t", "trial", "model", "push", "stage", "n"]) {
    const values = columns[name];
    for (let i = 1; i < values.length; i++) values[i] += values[i - 1];
  }
  const linkNumbers = Array.from(columns.model,
    (model) => model < 0 ? 0 : 3 * run.models[model].links.length);
  const ids = rows(columns.ids, columns.n), x = rows(columns.x, columns.n);
  const y = rows(columns.y, columns.n), motion = rows(columns.motion, linkNumbers);
  const truth = run.truth
    && rows(columns.truth, Array(run.frames).fill(3 * run.truth.sizes.length));
  run.frames = ids.map((_, f) => ({
    t: columns.t[f] * run.time_s, trial: columns.trial[f], model: columns.model[f],
    push: columns.push[f], stage: columns.stage[f], ids: ids[f], x: x[f], y: y[f],
    motion: motion[f], truth: truth && truth[f],
  }));
  for (const model of run.models) index(model);
  return run;
}

// The link of each point of a model by id.
function index(model) {
  model.linkOf = new Map(model.ids.map((id, i) => [id, model.link_of[i]]));
}

// What a live run has news of.
function apply(run, news) {
  if (news.info) run.info = news.info;
  if (!news.frames) return;
  for (const [i, model] of news.models) {
    index(model);
    run.models[i] = model;
  }
  for (const [i, push] of news.pushes) run.pushes[i] = push;
  for (const [i, trial] of news.trials) run.trials[i] = trial;
  if (news.last && run.frames.length) Object.assign(run.frames[news.first - 1], news.last);
  run.frames.length = news.first;
  run.frames.push(...news.frames);
}

function withinPage() {
  const text = document.getElementById("data").textContent.trim();
  if (!text) return null;
  const bytes = atob(text);
  return Uint8Array.from(bytes, (c) => c.charCodeAt(0));
}

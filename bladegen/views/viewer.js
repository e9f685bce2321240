"use strict";
// Draws the scene of the page by WebGL 2: the surface with its colours, lines of any width, and
// labels. The camera is a rotation (rows right, up, towards the eye), a focus and a distance.
(() => {
  const scene = JSON.parse(document.getElementById("scene").textContent);
  const canvas = document.getElementById("view");
  const gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
  if (!gl) {
    document.getElementById("sorry").hidden = false;
    return;
  }

  // --- data -------------------------------------------------------------------------------
  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
  const positions = new Float32Array(bytes(scene.points));
  const faces = new Uint32Array(bytes(scene.faces));

  const SURFACE = [
    `#version 300 es
    in vec3 point; in vec3 normal; in float value;
    uniform mat3 turn; uniform vec3 focus; uniform vec4 lens; uniform float distance;
    out vec3 n; out float v;
    vec4 seen(vec3 p) {  // lens: 1 / half width, 1 / half height at distance 1, near, far
      vec3 e = turn * (p - focus); e.z -= distance;
      float w = PARALLEL ? distance : -e.z;
      float z = PARALLEL ? w * (2.0 * (-e.z - lens.z) / (lens.w - lens.z) - 1.0)
        : ((lens.w + lens.z) * -e.z - 2.0 * lens.w * lens.z) / (lens.w - lens.z);
      return vec4(e.xy * lens.xy, z, w);
    }
    void main() { gl_Position = seen(point); n = turn * normal; v = value; }`,
    `#version 300 es
    precision highp float;
    in vec3 n; in float v; out vec4 colour;
    uniform sampler2D palette; uniform vec3 plain; uniform bool coloured;
    uniform vec4 lights[8]; uniform int count;
    void main() {
      vec3 m = normalize(gl_FrontFacing ? n : -n);
      float lit = 0.0, shine = 0.0;
      for (int i = 0; i < count; i++) {
        vec3 l = normalize(lights[i].xyz);
        lit += lights[i].w * max(dot(m, l), 0.0);
        vec3 h = normalize(l + vec3(0.0, 0.0, 1.0));
        shine += lights[i].w * pow(max(dot(m, h), 0.0), 20.0);
      }
      vec3 base = coloured ? texture(palette, vec2((v * 255.0 + 0.5) / 256.0, 0.5)).rgb : plain;
      colour = coloured ? vec4(base * (0.5 + 0.55 * lit) + 0.04 * shine, 1.0)
        : vec4(base * (0.25 + 0.85 * lit) + 0.2 * shine, 1.0);
    }`,
  ];
  const LINES = [
    `#version 300 es
    in vec3 a; in vec3 b;
    uniform mat3 turn; uniform vec3 focus; uniform vec4 lens; uniform float distance;
    uniform vec2 pixels; uniform float width;
    vec4 seen(vec3 p) {
      vec3 e = turn * (p - focus); e.z -= distance; e.z += 0.0006 * distance;
      float w = PARALLEL ? distance : max(-e.z, lens.z);
      float z = PARALLEL ? w * (2.0 * (-e.z - lens.z) / (lens.w - lens.z) - 1.0)
        : ((lens.w + lens.z) * -e.z - 2.0 * lens.w * lens.z) / (lens.w - lens.z);
      return vec4(e.xy * lens.xy, z, w);
    }
    void main() {  // a segment is a strip of four corners: from end to end, from side to side
      vec4 s = seen(a), t = seen(b);
      vec2 along = (t.xy / t.w - s.xy / s.w) * pixels;
      along = length(along) > 0.0 ? normalize(along) : vec2(1.0, 0.0);
      vec2 across = vec2(-along.y, along.x) * width / pixels;
      vec4 end = gl_VertexID < 2 ? s : t;
      float side = gl_VertexID % 2 == 0 ? 1.0 : -1.0;
      gl_Position = end + vec4(across * side * end.w, 0.0, 0.0);
    }`,
    `#version 300 es
    precision highp float;
    uniform vec3 ink; out vec4 colour;
    void main() { colour = vec4(ink, 1.0); }`,
  ];

  function program(sources, parallel) {
    const made = gl.createProgram();
    sources.forEach((source, i) => {
      const shader = gl.createShader(i ? gl.FRAGMENT_SHADER : gl.VERTEX_SHADER);
      gl.shaderSource(shader, source.replaceAll("PARALLEL", String(parallel)));
      gl.compileShader(shader);
      gl.attachShader(made, shader);
    });
    ["point", "normal", "value", "a", "b"].forEach((name, i) =>
      gl.bindAttribLocation(made, i, name));
    gl.linkProgram(made);
    if (!gl.getProgramParameter(made, gl.LINK_STATUS)) {
      throw new Error(gl.getProgramInfoLog(made) || "the shaders do not link");
    }
    return { made, at: (name) => gl.getUniformLocation(made, name) };
  }
  const programs = [false, true].map((parallel) => ({
    surface: program(SURFACE, parallel),
    lines: program(LINES, parallel),
  }));

  function buffer(data, target = gl.ARRAY_BUFFER) {
    const made = gl.createBuffer();
    gl.bindBuffer(target, made);
    gl.bufferData(target, data, gl.STATIC_DRAW);
    return made;
  }
  function attribute(place, data, size, type, normalised, stride = 0, offset = 0) {
    gl.bindBuffer(gl.ARRAY_BUFFER, data);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, type, normalised, stride, offset);
  }

  const points = buffer(positions);
  const normals = buffer(new Int8Array(bytes(scene.normals)));
  const meshes = Object.fromEntries([{ name: "plain" }, ...scene.fields].map((field) => {
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    attribute(0, points, 3, gl.FLOAT, false);
    attribute(1, normals, 3, gl.BYTE, true, 4);
    let palette = null;
    if (field.values) {
      attribute(2, buffer(new Uint8Array(bytes(field.values))), 1, gl.UNSIGNED_BYTE, true);
      palette = gl.createTexture();
      gl.bindTexture(gl.TEXTURE_2D, palette);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB, 256, 1, 0, gl.RGB, gl.UNSIGNED_BYTE,
        new Uint8Array(bytes(field.palette)));
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    }
    buffer(faces, gl.ELEMENT_ARRAY_BUFFER);
    return [field.name, { array, palette, field }];
  }));
  gl.bindVertexArray(null);

  const layers = scene.layers.map((layer) => {
    const segments = [];
    for (const [count, m, text] of layer.lines) {
      const line = new Float32Array(bytes(text));
      for (let i = 0; i < count; i++) {
        for (let j = 0; j + 1 < m; j++) {
          const k = 3 * (i * m + j);
          segments.push(line.subarray(k, k + 6));
        }
      }
    }
    const joined = new Float32Array(6 * segments.length);
    segments.forEach((segment, i) => joined.set(segment, 6 * i));
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    const data = buffer(joined);
    for (const [place, offset] of [[3, 0], [4, 12]]) {
      attribute(place, data, 3, gl.FLOAT, false, 24, offset);
      gl.vertexAttribDivisor(place, 1);
    }
    return { ...layer, array, count: segments.length };
  });
  gl.bindVertexArray(null);

  const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255);
  const labels = scene.labels.map((label) => {
    const word = document.createElement("span");
    word.className = "label";
    word.textContent = label.text;
    word.style.color = label.colour;
    document.body.append(word);
    return { ...label, word };
  });

  // --- camera -----------------------------------------------------------------------------
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
    a[0] * b[1] - a[1] * b[0]];
  const scaled = (a, f) => a.map((x) => x * f);
  const sum = (a, b) => a.map((x, i) => x + b[i]);
  const unit = (a) => scaled(a, 1 / Math.hypot(...a));
  const reach = Math.tan((scene.angle * Math.PI) / 360);
  const some = [];
  for (let i = 0; i < positions.length; i += 3 * Math.max(1, Math.floor(positions.length / 9000))) {
    some.push([positions[i], positions[i + 1], positions[i + 2]]);
  }
  const middle = [0, 1, 2].map((i) => 0.5 * (Math.min(...some.map((p) => p[i])) +
    Math.max(...some.map((p) => p[i]))));
  const radius = 1.1 * Math.max(...some.map((p) => Math.hypot(...sum(p, scaled(middle, -1)))));
  const camera = { axes: null, focus: middle, distance: 1, parallel: false };

  function look(name) {  // as near as all can be seen
    const view = scene.views[name];
    const towards = unit(view.towards);
    const right = unit(cross(view.up, towards));
    camera.axes = [right, cross(towards, right), towards];
    camera.parallel = view.parallel;
    const aspect = canvas.clientWidth / canvas.clientHeight;
    const wide = 0.9 * reach * aspect;
    const high = 0.8 * reach;
    let focus = middle;
    let distance = radius;
    for (let step = 0; step < 12; step++) {
      const seen = some.map((p) => camera.axes.map((a) => dot(a, sum(p, scaled(focus, -1)))));
      const depth = view.parallel ? () => 0 : (s) => s[2];
      distance = Math.max(...seen.map((s) =>
        depth(s) + Math.max(Math.abs(s[0]) / wide, Math.abs(s[1]) / high)));
      for (const i of [0, 1]) {
        const angles = seen.map((s) => s[i] / (distance - depth(s)));
        const shift = 0.5 * distance * (Math.max(...angles) + Math.min(...angles));
        focus = sum(focus, scaled(camera.axes[i], shift));
      }
    }
    Object.assign(camera, { focus, distance });
  }
  function turn(dx, dy) {  // radians about the screen's vertical and horizontal
    const spin = (a, b, angle) => [
      sum(scaled(a, Math.cos(angle)), scaled(b, -Math.sin(angle))),
      sum(scaled(b, Math.cos(angle)), scaled(a, Math.sin(angle)))];
    let [right, up, towards] = camera.axes;
    [right, towards] = spin(right, towards, -dx);
    [up, towards] = spin(up, towards, dy);
    towards = unit(towards);
    right = unit(cross(up, towards));
    camera.axes = [right, cross(towards, right), towards];
  }
  function move(dx, dy) {  // pixels
    const metres = (2 * reach * camera.distance) / canvas.clientHeight;
    camera.focus = sum(camera.focus, sum(scaled(camera.axes[0], -dx * metres),
      scaled(camera.axes[1], dy * metres)));
  }
  function settle(x, y) {  // brings the focus to the depth of what lies under the pointer
    if (camera.parallel) return;
    const half = canvas.clientHeight / (2 * reach);
    let [least, depth] = [Infinity, 0];
    for (const p of some) {
      const [r, u, t] = camera.axes.map((a) => dot(a, sum(p, scaled(camera.focus, -1))));
      const away = camera.distance - t;
      const off = Math.hypot((r / away) * half + canvas.clientWidth / 2 - x,
        canvas.clientHeight / 2 - (u / away) * half - y);
      if (away > 0 && off < least) [least, depth] = [off, t];
    }
    camera.focus = sum(camera.focus, scaled(camera.axes[2], depth));
    camera.distance -= depth;
  }
  function zoom(factor, x, y) {  // what lies under the pointer stays there
    settle(x, y);
    const wanted = Math.min(Math.max(camera.distance * factor, 0.002 * radius), 30 * radius);
    const kept = 1 - wanted / camera.distance;
    move(-(x - canvas.clientWidth / 2) * kept, -(y - canvas.clientHeight / 2) * kept);
    camera.distance = wanted;
  }

  // --- drawing ----------------------------------------------------------------------------
  const on = { layers: new Set(scene.on.layers), colour: scene.on.colour, view: scene.on.view,
    legend: true };
  let waiting = false;
  function redraw() {
    if (!waiting) {
      waiting = true;
      requestAnimationFrame(draw);
    }
  }
  function draw() {
    waiting = false;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(...rgb(scene.paper), 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    const aspect = width / height;
    const ahead = dot(camera.axes[2], sum(middle, scaled(camera.focus, -1)));
    const far = camera.distance - ahead + 1.2 * radius;
    const near = camera.parallel ? camera.distance - ahead - 1.2 * radius
      : Math.max(camera.distance - ahead - 1.2 * radius, 0.005 * camera.distance);
    const use = (chosen) => {
      gl.useProgram(chosen.made);
      gl.uniformMatrix3fv(chosen.at("turn"), true, camera.axes.flat());
      gl.uniform3fv(chosen.at("focus"), camera.focus);
      gl.uniform4f(chosen.at("lens"), 1 / (reach * aspect), 1 / reach, near, far);
      gl.uniform1f(chosen.at("distance"), camera.distance);
    };
    const { surface, lines } = programs[Number(camera.parallel)];
    if (!on.layers.has("wireframe")) {
      const mesh = meshes[on.colour];
      use(surface);
      gl.uniform3fv(surface.at("plain"), rgb(scene.surface));
      gl.uniform1i(surface.at("coloured"), Number(Boolean(mesh.palette)));
      gl.uniform4fv(surface.at("lights"), scene.lights.flat());
      gl.uniform1i(surface.at("count"), scene.lights.length);
      gl.bindTexture(gl.TEXTURE_2D, mesh.palette);
      gl.bindVertexArray(mesh.array);
      gl.drawElements(gl.TRIANGLES, faces.length, gl.UNSIGNED_INT, 0);
    }
    use(lines);
    gl.uniform2f(lines.at("pixels"), canvas.width, canvas.height);
    for (const layer of layers.filter((one) => on.layers.has(one.name))) {
      const ink = layer.name === "stations" && on.colour !== "plain" ? scene.ink : layer.colour;
      gl.uniform3fv(lines.at("ink"), rgb(ink));
      gl.uniform1f(lines.at("width"), Math.max(layer.width * ratio, 1));
      gl.bindVertexArray(layer.array);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, layer.count);
    }
    gl.bindVertexArray(null);
    for (const { name, point, word } of labels) {
      const seen = camera.axes.map((a) => dot(a, sum(point, scaled(camera.focus, -1))));
      const depth = camera.parallel ? camera.distance : camera.distance - seen[2];
      word.style.display = on.layers.has(name) && depth > 0 ? "" : "none";
      word.style.left = `${(0.5 + seen[0] / (2 * depth * reach * aspect)) * width}px`;
      word.style.top = `${(0.5 - seen[1] / (2 * depth * reach)) * height}px`;
    }
  }

  // --- keys and buttons -------------------------------------------------------------------
  const nav = document.querySelector("nav");
  const figure = document.querySelector("figure");
  function legend() {
    for (const button of nav.querySelectorAll("button")) {
      const { kind, target } = scene.keys[button.dataset.key];
      const active = { layer: on.layers.has(target), colour: on.colour === target,
        view: on.view === target, other: on.legend }[kind];
      button.setAttribute("aria-pressed", String(active));
    }
    nav.classList.toggle("closed", !on.legend);
    const { field } = meshes[on.colour];
    figure.hidden = on.colour === "plain" || on.layers.has("wireframe");
    if (!figure.hidden) {
      figure.querySelector("figcaption").textContent = field.label;
      const colours = new Uint8Array(bytes(field.palette));
      const stops = Array.from({ length: 33 }, (_, i) => {
        const k = 3 * Math.round((i * 255) / 32);
        return `rgb(${colours[k]}, ${colours[k + 1]}, ${colours[k + 2]})`;
      });
      document.getElementById("bar").style.background = `linear-gradient(90deg, ${stops})`;
      const ends = [0, 0.25, 0.5, 0.75, 1].map((f) => {
        const end = document.createElement("span");
        const value = field.low + f * (field.high - field.low);
        end.textContent = String(Number(value.toPrecision(4))).replace("-", "\u2212");
        return end;
      });
      document.getElementById("ends").replaceChildren(...ends);
    }
  }
  function press(key) {
    if (!(key in scene.keys)) return;
    const { kind, target } = scene.keys[key];
    if (kind === "layer" && !on.layers.delete(target)) on.layers.add(target);
    if (kind === "colour") on.colour = on.colour === target ? "plain" : target;
    if (kind === "view") {
      on.view = target;
      look(target);
    }
    if (kind === "other") on.legend = !on.legend;
    legend();
    redraw();
  }
  const rows = {};
  for (const [kind, word] of [["layer", "show"], ["colour", "colour"], ["view", "look at"],
    ["other", ""]]) {
    const name = document.createElement("b");
    name.textContent = word;
    rows[kind] = document.createElement("div");
    nav.append(name, rows[kind]);
  }
  for (const [key, { kind, target, help }] of Object.entries(scene.keys)) {
    const button = document.createElement("button");
    button.dataset.key = key;
    button.title = help;
    const cap = document.createElement("kbd");
    cap.textContent = key;
    button.append(cap, target);
    button.addEventListener("click", () => press(key));
    rows[kind].append(button);
  }
  const hint = document.createElement("small");
  hint.textContent = "drag to turn, right button or two fingers to move, wheel to zoom";
  rows.other.append(hint);
  window.addEventListener("keydown", (event) => {
    if (!event.ctrlKey && !event.metaKey && !event.altKey) press(event.key.toLowerCase());
  });

  // --- pointers ---------------------------------------------------------------------------
  const pointers = new Map();
  const spread = () => {
    const [a, b] = [...pointers.values()];
    return [Math.hypot(a[0] - b[0], a[1] - b[1]), (a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  canvas.addEventListener("pointermove", (event) => {
    const last = pointers.get(event.pointerId);
    if (!last) return;
    const [dx, dy] = [event.clientX - last[0], event.clientY - last[1]];
    const before = pointers.size === 2 ? spread() : null;
    pointers.set(event.pointerId, [event.clientX, event.clientY]);
    if (before) {
      const [size, x, y] = spread();
      move(x - before[1], y - before[2]);
      zoom(before[0] / Math.max(size, 1), x, y);
    } else if (event.buttons !== 1 || event.shiftKey) {
      move(dx, dy);
    } else {
      turn((dx * Math.PI) / canvas.clientHeight, (dy * Math.PI) / canvas.clientHeight);
    }
    on.view = "";
    legend();
    redraw();
  });
  for (const name of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(name, (event) => pointers.delete(event.pointerId));
  }
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("dblclick", () => press("1"));
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom(Math.exp(0.0015 * Math.max(-200, Math.min(200, event.deltaY))), event.clientX,
      event.clientY);
    redraw();
  }, { passive: false });
  window.addEventListener("resize", () => {
    if (on.view) look(on.view);
    redraw();
  });

  look(on.view);
  legend();
  draw();
})();

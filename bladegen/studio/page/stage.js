// The 3D view: fetches packets of a surface (see model.Scene.packet) and draws the latest one.
// World axes: X along the blade, Y to the suction side, Z to the trailing edge.
// Draws only when something moved, so that an idle page costs nothing.
import { OrbitControls, THREE } from "nicegui-scene";

const OUTWARD = [0xc9, 0x5a, 0x0a]; // orange and blue: told apart by all eyes
const INWARD = [0x1f, 0x6f, 0xb8];
const REST = { light: [0xdf, 0xe4, 0xea], dark: [0xb4, 0xbf, 0xcb] };
const VIEWS = {
  // eye from the target, in lengths of what is looked at, and its part of the span
  blade: { eye: [-0.42, 0.34, 0.6], from: 0, to: 1 },
  root: { eye: [-0.75, 0.6, 0.9], from: 0, to: 0.22 },
  tip: { eye: [0.55, 0.6, 0.95], from: 0.8, to: 1 },
  flat: { eye: [0, 1, 0.0001], from: 0, to: 1 },
  edge: { eye: [0, 0, 1], from: 0, to: 1 },
};

const ROOM = [0.92, 0.7]; // of the view's half width and height that a fit fills

const BESIDE = 0xd9c7a0; // the other blade
const APART = 0.075; // of its length, which it stands below and behind

const REST_MS = 500;
const ROUGH = 0.7; // pixels drawn for one that is shown, while a picture without a GPU moves
const FINE = 1.5;

function drawsInSoftware() {
  const gl = document.createElement("canvas").getContext("webgl2");
  const info = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
}

const linear = (rgb) => new THREE.Color().setRGB(...rgb.map((v) => v / 255), THREE.SRGBColorSpace).toArray();

export default {
  template: `
    <div class="stage" role="img" :aria-label="label">
      <canvas></canvas>
      <div class="stage-fault" hidden>This browser gives no WebGL: the blade cannot be drawn.</div>
    </div>`,
  props: { label: String },
  mounted() {
    this.shown = 0; // packets drawn
    this.wanted = null;
    this.loading = false;
    this.colours = true;
    this.view = "blade";
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(28, 1, 0.1, 2000);
    this.software = drawsInSoftware();
    try {
      this.renderer = new THREE.WebGLRenderer({
        canvas: this.$el.querySelector("canvas"),
        antialias: !this.software,
        alpha: true,
      });
    } catch {
      this.$el.querySelector(".stage-fault").hidden = false;
      return;
    }
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8d99a8, 1.5));
    const key = new THREE.DirectionalLight(0xffffff, 2.1);
    const rim = new THREE.DirectionalLight(0xffffff, 0.5);
    key.position.set(-60, 100, 80);
    rim.position.set(80, -40, -60);
    this.scene.add(key, rim);
    this.material = this.software
      ? new THREE.MeshLambertMaterial({ vertexColors: true })
      : new THREE.MeshStandardMaterial({ vertexColors: true, roughness: 0.55, metalness: 0.05 });
    this.blade = new THREE.Mesh(new THREE.BufferGeometry(), this.material);
    this.ring = new THREE.LineLoop(
      new THREE.BufferGeometry(),
      new THREE.LineBasicMaterial({ color: 0x111827 }),
    );
    this.ghost = new THREE.LineSegments(
      new THREE.BufferGeometry(),
      new THREE.LineBasicMaterial({ color: 0x6b7280, transparent: true, opacity: 0.5 }),
    );
    this.ghost.visible = false;
    this.scene.add(this.blade, this.ring, this.ghost);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener("change", this.draw);
    this.controls.addEventListener("start", () => (this.turned = true));
    const table = document.querySelector(".figures");
    this.grown = new ResizeObserver(() => !this.turned && this.hidden() && this.fit());
    if (table) this.grown.observe(table);
    this.resized = new ResizeObserver(this.resize);
    this.resized.observe(this.$el);
    this.themed = new MutationObserver(() => this.recolour());
    this.themed.observe(document.body, { attributes: true, attributeFilter: ["class"] });
    this.resize();
  },
  beforeUnmount() {
    this.resized?.disconnect();
    this.grown?.disconnect();
    this.themed?.disconnect();
    clearTimeout(this.resting);
    this.controls?.dispose();
    this.blade?.geometry.dispose();
    this.renderer?.dispose();
  },
  methods: {
    // Show what lies at `url`; another blade comes with the place of its baseline.  While one
    // packet loads, only the latest of the others waits.
    async show(url, baseline) {
      this.wanted = { url, baseline: baseline || (this.wanted?.baseline ?? "") };
      if (this.loading || !this.renderer) return;
      this.loading = true;
      while (this.wanted) {
        const { url, baseline } = this.wanted;
        this.wanted = null;
        try {
          if (baseline) {
            this.take(await this.fetched(baseline));
            this.outline();
          }
          this.take(await this.fetched(url));
          if (baseline) this.fit();
          this.shown += 1;
          this.$el.dataset.shown = this.shown;
          this.paintNow();
        } catch {
          // the server is gone or starts again; the page says so by itself
        }
      }
      this.loading = false;
    },
    async fetched(url) {
      const answer = await fetch(url, { cache: "no-store" });
      if (!answer.ok) throw new Error(answer.statusText);
      return answer.arrayBuffer();
    },
    take(packet) {
      const [k, n, place] = new Uint32Array(packet, 0, 3);
      const points = new Float32Array(packet, 12, 3 * k * n);
      const off = new Float32Array(packet, 12 + 12 * k * n, k * n);
      if (k !== this.k || n !== this.n) this.build(k, n);
      const at = this.blade.geometry.attributes.position.array;
      const { source } = this;
      for (let to = 0; to < source.length; to++) {
        const from = 3 * source[to];
        at[3 * to] = points[from + 2];
        at[3 * to + 1] = points[from];
        at[3 * to + 2] = points[from + 1];
      }
      this.off = off;
      this.blade.geometry.attributes.position.needsUpdate = true;
      this.blade.geometry.computeVertexNormals();
      this.blade.geometry.computeBoundingSphere();
      this.circle(place);
      this.length = at[3 * (k - 1) * n] || 1;
      this.recolour();
    },
    // Vertices: the grid; both edges once more, for a sharp trailing edge; the end sections
    // once more, for flat caps.
    build(k, n) {
      [this.k, this.n] = [k, n];
      const source = Array.from({ length: k * n }, (_, i) => i);
      const index = [];
      const quad = (a, b, c, d) => index.push(a, b, c, a, c, d);
      for (let i = 0; i + 1 < k; i++)
        for (let j = 0; j + 1 < n; j++)
          quad(i * n + j, (i + 1) * n + j, (i + 1) * n + j + 1, i * n + j + 1);
      const edge = source.length;
      for (let i = 0; i < k; i++) source.push(i * n + n - 1, i * n);
      for (let i = 0; i + 1 < k; i++)
        quad(edge + 2 * i, edge + 2 * i + 2, edge + 2 * i + 3, edge + 2 * i + 1);
      for (const row of [0, k - 1]) {
        const cap = source.length;
        for (let j = 0; j < n; j++) source.push(row * n + j);
        for (let j = 0; j < (n - 1) / 2; j++)
          if (row) quad(cap + n - 2 - j, cap + j + 1, cap + j, cap + n - 1 - j);
          else quad(cap + n - 1 - j, cap + j, cap + j + 1, cap + n - 2 - j);
      }
      this.source = Uint32Array.from(source);
      const geometry = new THREE.BufferGeometry();
      for (const name of ["position", "color"])
        geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(3 * source.length), 3));
      geometry.setIndex(index);
      this.blade.geometry.dispose();
      this.blade.geometry = geometry;
    },
    circle(place) {
      const at = this.blade.geometry.attributes.position.array;
      const row = at.slice(3 * place * this.n, 3 * (place + 1) * this.n);
      let middle = [0, 1, 2].map((c) => row.reduce((s, v, i) => (i % 3 === c ? s + v : s), 0) / this.n);
      for (let i = 0; i < row.length; i++) row[i] += 0.006 * (row[i] - middle[i % 3]);
      this.ring.geometry.dispose();
      this.ring.geometry = new THREE.BufferGeometry();
      this.ring.geometry.setAttribute("position", new THREE.BufferAttribute(row, 3));
    },
    // The baseline's outline: leading and trailing edge, and some sections.
    outline() {
      const at = this.blade.geometry.attributes.position.array;
      const { k, n } = this;
      const lines = [];
      const to = (i, j) => lines.push(...at.slice(3 * (i * n + j), 3 * (i * n + j) + 3));
      for (const j of [0, (n - 1) / 2]) for (let i = 0; i + 1 < k; i++) to(i, j), to(i + 1, j);
      for (let s = 0; s <= 10; s++) {
        const i = Math.round((s / 10) * (k - 1));
        for (let j = 0; j + 1 < n; j++) to(i, j), to(i, j + 1);
      }
      this.ghost.geometry.dispose();
      this.ghost.geometry = new THREE.BufferGeometry();
      this.ghost.geometry.setAttribute("position", new THREE.Float32BufferAttribute(lines, 3));
    },
    // Another blade, as it is, beside this one; none without a place of it.
    async beside(url) {
      const packet = url ? await this.fetched(url) : null;
      if (!this.renderer) return;
      if (this.other) {
        this.scene.remove(this.other);
        this.other.geometry.dispose();
      }
      this.other = packet ? this.neighbour(packet) : null;
      if (this.other) this.scene.add(this.other);
      this.$el.dataset.beside = Boolean(this.other);
      this.fit();
    },
    neighbour(packet) {
      const [k, n] = new Uint32Array(packet, 0, 3);
      const points = new Float32Array(packet, 12, 3 * k * n);
      const at = points.map((_, i) => points[3 * Math.floor(i / 3) + ((i + 2) % 3)]);
      const index = [];
      for (let i = 0; i + 1 < k; i++)
        for (let j = 0; j < n; j++) {
          const [a, b] = [i * n + j, i * n + ((j + 1) % n)];
          index.push(a, a + n, b + n, a, b + n, b);
        }
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(at, 3));
      geometry.setIndex(index);
      geometry.computeVertexNormals();
      const material = new THREE.MeshLambertMaterial({ color: BESIDE, side: THREE.DoubleSide });
      const mesh = new THREE.Mesh(geometry, material);
      const apart = APART * at[3 * (k - 1) * n];
      mesh.position.set(0, -apart, apart);
      return mesh;
    },
    recolour() {
      if (!this.off || !this.renderer) return;
      const dark = document.body.classList.contains("body--dark");
      const [rest, outward, inward] = [dark ? REST.dark : REST.light, OUTWARD, INWARD].map(linear);
      this.ring.material.color.set(dark ? 0xffffff : 0x111827);
      let most = 0;
      for (const v of this.off) most = Math.max(most, Math.abs(v));
      const scale = this.colours && most > 5e-4 ? 1 / most : 0;
      const out = this.blade.geometry.attributes.color.array;
      const { source, off } = this;
      for (let to = 0; to < source.length; to++) {
        const v = off[source[to]] * scale;
        const aim = v > 0 ? outward : inward;
        const share = Math.abs(v);
        for (let c = 0; c < 3; c++) out[3 * to + c] = rest[c] + share * (aim[c] - rest[c]);
      }
      this.blade.geometry.attributes.color.needsUpdate = true;
      this.draw();
    },
    paint(colours) {
      this.colours = colours;
      this.recolour();
    },
    overlay(visible) {
      if (!this.renderer) return;
      this.ghost.visible = visible;
      this.draw();
    },
    look(view) {
      this.view = view;
      this.turned = false;
      this.fit();
    },
    // Move the eye so that a part of the span fills the view, and only just.
    fit() {
      if (!this.length || !this.renderer) return;
      const { eye, from, to } = VIEWS[this.view];
      const at = this.blade.geometry.attributes.position;
      const part = [];
      const v = new THREE.Vector3();
      for (let i = 0; i < this.k * this.n; i += 7) {
        v.fromBufferAttribute(at, i);
        if (v.x >= from * this.length - 1e-3 && v.x <= to * this.length + 1e-3) part.push(v.clone());
      }
      const other = this.other?.geometry.attributes.position;
      for (let i = 0; i < (other?.count ?? 0); i += 7) {
        v.fromBufferAttribute(other, i).add(this.other.position);
        if (v.x >= from * this.length - 1e-3 && v.x <= to * this.length + 1e-3) part.push(v.clone());
      }
      const box = new THREE.Box3().setFromPoints(part);
      const target = box.getCenter(new THREE.Vector3());
      const away = new THREE.Vector3(...eye).normalize();
      const covered = this.covered();
      this.part = part;
      this.approach(target, away, part, 0, ROOM[0]);
      if (covered && this.hidden()) {
        box.getCenter(target);
        this.approach(target, away, part, -covered.share, ROOM[0] - covered.share);
      }
      this.controls.target.copy(target);
      this.controls.update();
      this.draw();
    },
    // The table of figures over this view: its share of the width, and where it begins.
    covered() {
      const table = document.querySelector(".figures")?.getBoundingClientRect();
      const view = this.$el.getBoundingClientRect();
      if (!table?.width || table.left >= view.right || table.top >= view.bottom) return null;
      const share = (view.right - table.left) / view.width;
      return share < 0.6 ? { share, low: 1 - (2 * (table.top - view.top)) / view.height } : null;
    },
    // Whether a part of what is looked at lies behind the table.
    hidden() {
      const covered = this.covered();
      if (!covered || !this.part) return false;
      this.camera.updateMatrixWorld();
      return this.part.some((p) => {
        const { x, y } = p.clone().project(this.camera);
        return x > 1 - 2 * covered.share && y < covered.low;
      });
    },
    // Move the eye along a line, so that points fill a room about a place of the view's width.
    approach(target, away, part, middle, room) {
      this.camera.near = 0.01;
      this.camera.far = 100 * this.length;
      this.camera.updateProjectionMatrix();
      let distance = 3 * this.length;
      const side = new THREE.Vector3();
      const up = new THREE.Vector3();
      for (let step = 0; step < 24; step++) {
        this.camera.position.copy(target).addScaledVector(away, distance);
        this.camera.lookAt(target);
        this.camera.updateMatrixWorld();
        const seen = part.map((p) => p.clone().project(this.camera));
        const ends = new THREE.Box3().setFromPoints(seen);
        const wide = Math.max((ends.max.x - ends.min.x) / (2 * room), (ends.max.y - ends.min.y) / (2 * ROOM[1]));
        const half = distance * Math.tan((this.camera.fov * Math.PI) / 360);
        this.camera.matrixWorld.extractBasis(side, up, new THREE.Vector3());
        target.addScaledVector(side, (0.5 * (ends.max.x + ends.min.x) - middle) * half * this.camera.aspect);
        target.addScaledVector(up, 0.5 * (ends.max.y + ends.min.y) * half);
        const behind = part.some((p) => side.copy(p).sub(this.camera.position).dot(away) > -0.02 * distance);
        distance *= behind ? 1.3 : Math.min(1.25, Math.max(0.8, wide));
      }
      this.camera.position.copy(target).addScaledVector(away, distance);
      const far = distance;
      this.camera.near = this.length / 500;
      this.camera.far = far + 3 * this.length;
      this.camera.updateProjectionMatrix();
    },
    resize() {
      const { clientWidth, clientHeight } = this.$el;
      if (!clientWidth || !clientHeight || !this.renderer) return;
      this.size = [clientWidth, clientHeight];
      this.camera.aspect = clientWidth / clientHeight;
      this.camera.updateProjectionMatrix();
      this.fit();
      this.draw();
    },
    // Without a GPU, a picture that moves is drawn roughly, and once more when it rests.
    draw() {
      clearTimeout(this.resting);
      if (this.waiting) return;
      this.waiting = requestAnimationFrame(this.paintNow);
    },
    // At once, so that a surface that has come is in the next frame and not in the one after it.
    paintNow() {
      clearTimeout(this.resting);
      cancelAnimationFrame(this.waiting);
      this.waiting = 0;
      this.render(this.software ? ROUGH : Math.min(window.devicePixelRatio, 2));
      this.$el.dataset.drawn = this.shown;
      if (this.software) this.resting = setTimeout(() => this.render(FINE), REST_MS);
    },
    render(ratio) {
      if (!this.size) return;
      const wanted = `${this.size} ${ratio}`;
      if (wanted !== this.buffer) {
        this.buffer = wanted; // a new one costs much, even of the same size
        this.renderer.setPixelRatio(ratio);
        this.renderer.setSize(...this.size, false);
      }
      this.renderer.render(this.scene, this.camera);
      this.$el.dataset.fine = !this.software || ratio > 1;
    },
  },
};

// Curves over span with handles that are dragged; the server sends the picture, and hears of a
// handle's wanted value once a frame.  A handle knows its plot's scale: value = high - per * (y - top).
const KEYS = { ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1 };

export default {
  template: `<div class="plot" @pointerdown="take" @pointermove="drag" @pointerup="drop" @pointercancel="drop"
    @keydown="key" @focusout="settle" @dblclick="back"></div>`,
  emits: ["drag", "settle"],
  methods: {
    put(picture) {
      const focus = this.name(document.activeElement);
      this.quiet = true; // the focus goes and comes back
      this.$el.innerHTML = picture;
      if (focus) this.$el.querySelector(focus)?.focus();
      this.quiet = false;
    },
    name(element) {
      if (!this.$el.contains(element) || !element.dataset.curve) return "";
      return `.handle[data-curve="${element.dataset.curve}"][data-knot="${element.dataset.knot}"]`;
    },
    take(event) {
      const handle = event.target.closest?.(".handle");
      if (!handle) return;
      event.preventDefault();
      this.held = this.name(handle);
      handle.focus();
      this.$el.setPointerCapture(event.pointerId);
    },
    drag(event) {
      const handle = this.held && this.$el.querySelector(this.held);
      if (!handle) return;
      const { top, high, per } = handle.dataset;
      const svg = handle.ownerSVGElement;
      const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
      this.want(handle, high - per * (at.y - top));
    },
    drop() {
      if (!this.held) return;
      this.held = "";
      this.settle();
    },
    key(event) {
      const { curve, value, step } = event.target.dataset;
      if (!curve || !KEYS[event.key] || event.ctrlKey || event.metaKey) return;
      event.preventDefault();
      this.want(event.target, Number(value) + KEYS[event.key] * step * (event.shiftKey ? 10 : 1));
    },
    back(event) {
      const { curve, knot } = event.target.dataset;
      if (curve) this.$emit("drag", { curve, knot: Number(knot), value: null });
    },
    want(handle, value) {
      const { curve, knot } = handle.dataset;
      this.next = { curve, knot: Number(knot), value };
      this.unsettled = true;
      if (this.waiting) return;
      this.waiting = requestAnimationFrame(() => {
        this.waiting = 0;
        this.$emit("drag", this.next);
      });
    },
    settle() {
      if (this.quiet || !this.unsettled) return;
      this.unsettled = false;
      requestAnimationFrame(() => this.$emit("settle"));
    },
  },
};

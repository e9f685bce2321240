// A number: label, slider and field, which agree at once; the server hears of moves once a frame.
const PATIENCE = 250; // ms that a pointer rests
const WIDE = 336; // of the picture, with its border
const HIGH = 200;

export default {
  template: `
    <div class="number" :title="peeks ? null : hint" @mouseenter="rest" @mouseleave="hide" @focusin="rest"
      @focusout="hide" @keydown.esc="hide">
      <label :for="'slide-' + name">{{ label }}<span v-if="unit">{{ unit }}</span><small v-if="effect">{{ effect }}</small></label>
      <input type="range" :id="'slide-' + name" :min="low" :max="high" :step="step"
        :aria-label="spoken" :aria-description="hint" @input="moved" @pointerup="settled" @blur="settled" />
      <input type="number" :min="low" :max="high" :step="step" :aria-label="spoken + ', value'"
        @change="$emit('type', $event.target.value)" @focus="$event.target.select()" />
      <div class="peek" role="tooltip" v-if="peeked" :style="place" v-html="peeked"></div>
    </div>`,
  props: {
    name: String,
    label: String,
    hint: String,
    unit: String,
    low: Number,
    high: Number,
    step: Number,
    places: Number,
    first: Number,
    effect: String,
    peeks: Boolean,
  },
  emits: ["move", "settle", "type", "peek"],
  data: () => ({ peeked: "", place: "" }),
  computed: {
    spoken() {
      return this.unit ? `${this.label} [${this.unit}]` : this.label;
    },
  },
  mounted() {
    [this.slider, this.field] = this.$el.querySelectorAll("input");
    this.put(this.first);
  },
  methods: {
    put(value) {
      this.slider.value = value;
      this.field.value = Number(value).toFixed(this.places);
      const share = (this.slider.value - this.low) / (this.high - this.low);
      this.slider.style.setProperty("--share", share);
    },
    // A pointer that rests, or the focus, asks what the number does; a move takes the answer away.
    rest() {
      if (!this.peeks || this.asked) return;
      this.asked = setTimeout(() => this.$emit("peek"), PATIENCE);
    },
    hide() {
      clearTimeout(this.asked);
      this.asked = 0;
      this.peeked = "";
    },
    picture(html) {
      if (!this.asked) return;
      const { right, top } = this.$el.getBoundingClientRect();
      const left = Math.min(right + 12, window.innerWidth - WIDE);
      const below = left < right ? this.$el.offsetHeight : 0; // a narrow screen has no room beside it
      this.place = `left: ${Math.max(4, left)}px; top: ${Math.min(top + below, window.innerHeight - HIGH)}px`;
      this.peeked = html;
    },
    moved() {
      if (this.peeked || this.asked) this.hide();
      this.put(this.slider.value);
      this.unsettled = true;
      this.slider.dataset.moved = performance.now();
      if (this.waiting) return;
      this.waiting = requestAnimationFrame(() => {
        this.waiting = 0;
        this.$emit("move", Number(this.slider.value));
      });
    },
    settled() {
      if (!this.unsettled) return;
      this.unsettled = false;
      requestAnimationFrame(() => this.$emit("settle"));
    },
  },
};

// A number: label, slider and field, which agree at once; the server hears of moves once a frame.
export default {
  template: `
    <div class="number" :title="hint">
      <label :for="'slide-' + name">{{ label }}<span v-if="unit">{{ unit }}</span></label>
      <input type="range" :id="'slide-' + name" :min="low" :max="high" :step="step"
        :aria-label="spoken" :aria-description="hint" @input="moved" @pointerup="settled" @blur="settled" />
      <input type="number" :min="low" :max="high" :step="step" :aria-label="spoken + ', value'"
        @change="$emit('type', $event.target.value)" @focus="$event.target.select()" />
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
  },
  emits: ["move", "settle", "type"],
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
    moved() {
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

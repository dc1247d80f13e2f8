// Intervals, and axes as data: {name, type, min, max}, `type` one of value, log and category. An axis may say more:
// `data` (names of a category, the first on top), `frame` (which of the chart's), `hidden`, `plain` (no lines across),
// `bare` (no words).
{
  // An interval of an axis; empty until something is included.
  class Interval {
    constructor(low = 1, high = -1) {
      this.low = low;
      this.high = high;
    }
    get empty() { return !(this.low <= this.high); }
    include(...values) {
      for (const value of values) {
        if (!Number.isFinite(value)) continue;
        if (this.empty) this.low = this.high = value;
        else {
          this.low = Math.min(this.low, value);
          this.high = Math.max(this.high, value);
        }
      }
      return this;
    }
    join(other) { return other.empty ? this : this.include(other.low, other.high); }
    copy() { return new Interval(this.low, this.high); }
  }

  // Powers of ten to the last bit, which Math.pow does not give.
  const ten = (k) => Number("1e" + k);
  // The least of 1, 2, 5 times a power of ten that is not below.
  const roundStep = (raw) => {
    const decade = ten(Math.floor(Math.log10(raw)));
    return decade * ([1, 2, 5].find((factor) => factor * decade >= raw) || 10);
  };
  // Rounded outwards to a round step of about five ticks, at least `least` wide.
  function roundOutwards({low, high}, least) {
    least = Math.max(least, 1e-13 * Math.max(Math.abs(low), Math.abs(high)));
    if (high - low < least) {
      const middle = 0.5 * (low + high);
      low = middle - 0.5 * least;
      high = middle + 0.5 * least;
    }
    const step = roundStep((high - low) / 5);
    return new Interval(step * Math.floor(low / step + 1e-9), step * Math.ceil(high / step - 1e-9));
  }
  // A span below which differences are not worth their look: 0.2 % of the largest.
  const leastSpan = ({low, high}) => 2e-3 * Math.max(Math.abs(low), Math.abs(high)) || 2e-3;
  // Rounded outwards to whole decades; needs 0 < low.
  function wholeDecades(interval) {
    const low = Math.floor(Math.log10(interval.low) + 1e-9), high = Math.ceil(Math.log10(interval.high) - 1e-9);
    return new Interval(ten(low), ten(high <= low ? low + 1 : high));
  }
  // The intervals of small multiples, made equal so that they compare. One whose largest magnitude is over 4 times the
  // median one keeps its own: it would flatten the others. On a logarithmic axis none is flattened.
  function sharedFrames(ranges, logarithmic = false) {
    const magnitude = (range) => Math.max(Math.abs(range.low), Math.abs(range.high));
    const sizes = ranges.filter((range) => !range.empty).map(magnitude).sort((a, b) => a - b);
    const usual = sizes.length ? sizes[(sizes.length - 1) >> 1] : 0,
          apart = (range) => !logarithmic && !range.empty && magnitude(range) > 4 * usual;
    const shared = new Interval();
    ranges.filter((range) => !apart(range)).forEach((range) => shared.join(range));
    return ranges.map((range) => ({range: apart(range) ? range : shared, own: apart(range)}));
  }
  // Edges of cells around values, half-way between them on the scale of their axis; `alone` is half the width of a
  // single one.
  function cellEdges(values, logarithmic, alone = 0.5) {
    const at = logarithmic ? values.map(Math.log) : values, n = at.length,
          half = (k) => (n > 1 ? 0.5 * (at[k + 1] - at[k]) : alone);
    const out = [at[0] - half(0), ...at.slice(1).map((value, k) => 0.5 * (at[k] + value)), at[n - 1] + half(n - 2)];
    return logarithmic ? out.map(Math.exp) : out;
  }

  const valueAxis = (quantity, range) => ({
    name: ricochet.format.withUnit(quantity),
    type: "value",
    ...(range.empty ? {} : {min: range.low, max: range.high})
  });
  function logAxis(quantity, range) {
    const {low, high} = wholeDecades(range);
    return {name: ricochet.format.withUnit(quantity), type: "log", min: low, max: high};
  }
  const axisOf = (logarithmic, quantity, range) => (logarithmic ? logAxis : valueAxis)(quantity, range);
  // A vertical axis whose name says where it does not begin at zero.
  function heightAxis(quantity, range) {
    const fromZero = range.low <= 0 && range.high >= 0;
    return valueAxis([ricochet.format.withUnit(quantity) + (fromZero ? "" : ", axis not from 0"), "1"], range);
  }
  // A second vertical axis from 0 to 1.
  const gutterAxis = () => ({type: "value", min: 0, max: 1, hidden: true});

  // Values of an axis and where they lie, pixels: `from` is the place of its least, `to` that of its largest.
  class Scale {
    constructor(axis, from, to) {
      const {type, data = []} = axis;
      Object.assign(this, {axis, from, to});
      this.places = type === "category" ? new Map(data.map((name, k) => [name, k])) : null;
      this.bend = type === "log" ? Math.log : (value) => value;
      this.low = type === "category" ? -0.5 : this.bend(axis.min);
      this.pixels =
          (this.to - this.from) / ((type === "category" ? data.length - 0.5 : this.bend(axis.max)) - this.low);
    }
    at(value) {
      const own = this.places && typeof value === "string" ? this.places.get(value) : value;
      return own === null || own === undefined ? NaN : this.from + (this.bend(own) - this.low) * this.pixels;
    }
    value(pixel) {
      const own = this.low + (pixel - this.from) / this.pixels;
      return this.axis.type === "log" ? Math.exp(own) : own;
    }
    // [{value, words}], words "" for small ticks.
    ticks() {
      const {axis} = this, length = Math.abs(this.to - this.from), vertical = this.vertical,
            most = Math.min(10, Math.max(2, Math.floor(length / (vertical ? 42 : 74))));
      if (axis.type === "category") return axis.data.map((words, value) => ({value, words}));
      return (axis.type === "log" && decadeTicks(axis, most)) || evenTicks(axis, most);
    }
  }
  function evenTicks({min, max}, most) {
    const step = roundStep((max - min) / most), out = [];
    for (let k = Math.ceil(min / step - 1e-9); k * step <= max + 1e-9 * step && out.length < 2 * most; ++k) {
      const value = Number((k * step).toPrecision(12));
      out.push({value, words: ricochet.format.shown(value)});
    }
    // One tick alone tells no scale.
    return out.length < 2 && most < 8 ? evenTicks({min, max}, 2 * most) : out;
  }
  // Whole powers at even distances, from the lowest on, and what lies between while there is room; null where the axis
  // has less than two of them, and no ticks of 1, 2, 5 either.
  function decadeTicks({min, max}, most) {
    const low = Math.ceil(Math.log10(min) - 1e-9), high = Math.floor(Math.log10(max) + 1e-9), out = [],
          between = high - low < 2, every = Math.ceil((high - low) / Math.min(most, 6)) || 1;
    if (max < 4 * min) return null;
    for (let k = low - 1; k <= high; ++k)
      for (let factor = 1; factor < 10; ++factor) {
        const value = Number(factor + "e" + k), named = factor === 1 || (between && (factor === 2 || factor === 5));
        if (value < min * (1 - 1e-9) || value > max * (1 + 1e-9) || (factor > 1 && high - low > 6)) continue;
        const words = !named || (k - low) % every !== 0 ? "" :
            factor === 1 && !between                    ? ricochet.format.power(value) :
                                                          ricochet.format.shown(value, 2);
        out.push({value, words});
      }
    return out;
  }

  // Whether numbers above zero over some factor are drawn on a logarithmic axis: nine for the values of a study's axis,
  // fifty for a sweep.
  const logarithmicAxis = (range) => range.low > 0 && range.high >= 9 * range.low,
        logarithmicSweep = (range) => range.low > 0 && range.high >= 50 * range.low;

  Object.assign(ricochet, {
    Interval,
    Scale,
    roundOutwards,
    leastSpan,
    wholeDecades,
    cellEdges,
    sharedFrames,
    valueAxis,
    logAxis,
    axisOf,
    heightAxis,
    gutterAxis,
    logarithmicAxis,
    logarithmicSweep,
  });
}

// Marks drawn pixel by pixel, all of a grid in one picture. The chart library knows none of them: hundreds of thousands
// of its own marks are slow. A source is {grid, axis, tags, z, colour, glyph, values, orbits}. Its `values` are pairs
// (x, y), or triples (x, low, high) where the glyph is a whisker.
{
  // Shape and size in CSS pixels. Starts are told apart by their marks while these are few; clouds are dots.
  const cloudGlyph = (shape, count) =>
      (count > 2500 ? {shape: "dot", size: count > 40000 ? 1.5 : 2} : {shape, size: count < 400 ? 6 : 5});

  // Coverage of the shape, 0 to 255, in device pixels around its centre. It is stored, as pixels are slow to read back.
  const masks = new Map();
  function maskOf(glyph, ratio) {
    const key = glyph.shape + glyph.size + "/" + ratio;
    if (!masks.has(key)) masks.set(key, makeMask(glyph, ratio));
    return masks.get(key);
  }
  function makeMask(glyph, ratio) {
    const size = Math.max(1, Math.round(glyph.size * ratio));
    if (glyph.shape === "dot") return {size, alpha: new Uint8Array(size * size).fill(255)};
    const canvas = Object.assign(document.createElement("canvas"), {width: size, height: size}),
          c = canvas.getContext("2d"), h = size / 2;
    c.beginPath();
    if (glyph.shape === "circle") c.arc(h, h, h, 0, 7);
    else if (glyph.shape === "rect") c.rect(0.5, 0.5, size - 1, size - 1);
    else if (glyph.shape === "triangle") {
      c.moveTo(h, 0);
      c.lineTo(size, size);
      c.lineTo(0, size);
    } else if (glyph.shape === "triangle-down") {
      c.moveTo(h, size);
      c.lineTo(size, 0);
      c.lineTo(0, 0);
    } else if (glyph.shape === "diamond") {
      c.moveTo(h, 0);
      c.lineTo(size, h);
      c.lineTo(h, size);
      c.lineTo(0, h);
    } else {
      c.moveTo(0, 0);
      c.lineTo(size, size);
      c.moveTo(size, 0);
      c.lineTo(0, size);
    }
    if (glyph.shape === "cross") c.stroke();
    else c.fill();
    const data = c.getImageData(0, 0, size, size).data, alpha = new Uint8Array(size * size);
    for (let i = 0; i < alpha.length; ++i) alpha[i] = data[4 * i + 3];
    return {size, alpha};
  }

  const rgb = (colour) => [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16));
  const word = ([r, g, b]) => (255 << 24) | (b << 16) | (g << 8) | r;
  const visible = (source, hidden) => !source.tags.some((tag) => hidden.has(tag));

  // A picture of one grid: pixels, and where values lie in them.
  class Picture {
    constructor({wide, tall}, frame, ratio, xAxis, first, last) {
      const canvas = Object.assign(document.createElement("canvas"), {width: wide, height: tall}),
            context = canvas.getContext("2d"), image = context.createImageData(wide, tall);
      Object.assign(
          this,
          {wide, tall, ratio, canvas, context, image, bytes: image.data, words: new Uint32Array(image.data.buffer)});
      this.bend = xAxis.type === "log" ? Math.log : (v) => v;
      this.low = this.bend(xAxis.min);
      this.left = (first[0] - frame.x) * ratio;
      this.perX = (last[0] - first[0]) * ratio / (this.bend(xAxis.max) - this.low);
      this.zero = (first[1] - frame.y) * ratio;
      this.perY = (last[1] - first[1]) * ratio;
    }
    across(x) { return this.left + (this.bend(x) - this.low) * this.perX; }
    up(y) { return this.zero + y * this.perY; }
    draw(source) {
      if (source.glyph.shape === "whisker") this.whiskers(source);
      else if (source.glyph.shape === "dot") this.dots(source);
      else this.stamps(source);
    }
    whiskers({values, colour}) {
      const ink = word(rgb(colour));
      for (let i = 0; i < values.length; i += 3) {
        const u = Math.floor(this.across(values[i])), from = Math.max(0, Math.floor(this.up(values[i + 2]))),
              to = Math.min(this.tall - 1, Math.floor(this.up(values[i + 1])));
        if (u < 0 || u >= this.wide) continue;
        for (let v = from; v <= to; ++v) this.words[v * this.wide + u] = ink;
      }
    }
    dots({values, colour, glyph}) {
      const {size} = maskOf(glyph, this.ratio), ink = word(rgb(colour)), shift = 0.5 - size / 2;
      for (let i = 0; i < values.length; i += 2) {
        const px = Math.floor(this.across(values[i]) + shift), py = Math.floor(this.up(values[i + 1]) + shift);
        if (px < 0 || py < 0 || px + size > this.wide || py + size > this.tall) continue;
        for (let row = 0, at = py * this.wide + px; row < size; ++row, at += this.wide)
          for (let column = 0; column < size; ++column) this.words[at + column] = ink;
      }
    }
    stamps({values, colour, glyph}) {
      const {size, alpha} = maskOf(glyph, this.ratio), paint = rgb(colour);
      for (let i = 0; i < values.length; i += 2) {
        const px = Math.round(this.across(values[i]) - size / 2), py = Math.round(this.up(values[i + 1]) - size / 2);
        if (px <= -size || py <= -size || px >= this.wide || py >= this.tall) continue;
        for (let row = Math.max(0, -py); row < size && py + row < this.tall; ++row)
          for (let column = Math.max(0, -px); column < size && px + column < this.wide; ++column)
            if (alpha[row * size + column])
              this.blend(4 * ((py + row) * this.wide + px + column), paint, alpha[row * size + column]);
      }
    }
    blend(at, paint, a) {
      const {bytes} = this, under = bytes[at + 3];
      for (let k = 0; k < 3; ++k)
        bytes[at + k] = a === 255 || under === 0 ? paint[k] : bytes[at + k] + (paint[k] - bytes[at + k]) * a / 255;
      bytes[at + 3] = Math.max(a, under);
    }
  }

  const painter = (sources, option, hidden, grid) => (params, api) => {
    const frame = params.coordSys, ratio = api.getDevicePixelRatio(),
          size = {wide: Math.round(frame.width * ratio), tall: Math.round(frame.height * ratio)},
          x = option.xAxis[grid];
    if (size.wide < 1 || size.tall < 1) return null;
    const picture = new Picture(size, frame, ratio, x, api.coord([x.min, 0]), api.coord([x.max, 1]));
    for (const source of sources.filter((one) => one.grid === grid && visible(one, hidden)).sort((a, b) => a.z - b.z))
      picture.draw(source);
    picture.context.putImageData(picture.image, 0, 0);
    return {
      type: "image",
      silent: true,
      style: {image: picture.canvas, x: frame.x, y: frame.y, width: frame.width, height: frame.height}
    };
  };

  ricochet.handDrawn = {
    cloudGlyph,
    // One series per grid that has sources, which draws them all.
    series(sources, option, hidden) {
      const grids = new Map(sources.map((source) => [source.grid, source.axis]));
      return Array.from(grids, ([grid, axis]) => ({
                                 type: "custom",
                                 name: "points of panel " + grid,
                                 xAxisIndex: grid,
                                 yAxisIndex: axis,
                                 silent: true,
                                 clip: true,
                                 progressive: 0,
                                 z: 3,
                                 renderItem: painter(sources, option, hidden, grid),
                                 encode: {x: 0, y: 1},
                                 data: [[option.xAxis[grid].min, 0]],
                               }));
    },
    // The mark nearest to a place of a grid, within `reach` pixels: {source, index, value}; null where there is none.
    // Whiskers are left out.
    nearest(chart, option, sources, hidden, grid, at, reach) {
      let best = null, nearest = reach;
      const axis = option.xAxis[grid], bend = axis.type === "log" ? Math.log : (v) => v,
            back = axis.type === "log" ? Math.exp : (v) => v;
      for (const source of sources) {
        if (source.glyph.shape === "whisker" || source.grid !== grid || !visible(source, hidden)) continue;
        // Both scales are straight in what they show: two points give them.
        const left = chart.convertToPixel({xAxisIndex: source.grid}, axis.min),
              right = chart.convertToPixel({xAxisIndex: source.grid}, axis.max);
        const zero = chart.convertToPixel({yAxisIndex: source.axis}, 0),
              unit = chart.convertToPixel({yAxisIndex: source.axis}, 1) - zero;
        const scale = (right - left) / (bend(axis.max) - bend(axis.min)), base = bend(axis.min),
              middle = base + (at[0] - left) / scale, around = Math.abs(reach / scale);
        const low = back(middle - around), high = back(middle + around), {values} = source;
        for (let i = 0; i < values.length; i += 2) {
          if (!(values[i] >= low && values[i] <= high)) continue;
          const away = Math.hypot(left + (bend(values[i]) - base) * scale - at[0], zero + values[i + 1] * unit - at[1]);
          if (away < nearest) {
            nearest = away;
            best = {source, index: i >> 1, value: values[i + 1]};
          }
        }
      }
      return best;
    },
  };
}

// What a chart is drawn with: a pen on a canvas, or one that writes SVG. Shapes are paths as SVG writes them. A style
// has fill, stroke, width, dash, cap and opacity. Colours are as charts say them, for white paper; `paint` carries them
// to what is drawn on.
{
  const family = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif";
  const fontOf = ({size = 12, bold}) => (bold ? "bold " : "") + size + "px " + family;
  const ruler = document.createElement("canvas").getContext("2d");
  // How wide words are, pixels.
  function widthOf(words, style = {}) {
    ruler.font = fontOf(style);
    return ruler.measureText(words).width;
  }
  // Words cut where they pass a width.
  function cutTo(words, width, style) {
    if (widthOf(words, style) <= width) return words;
    let out = words;
    while (out.length > 1 && widthOf(out + "…", style) > width) out = out.slice(0, -1);
    return out + "…";
  }
  // Words as lines that fit a width, cut within a word only where it is longer by itself.
  function linesOf(words, width, style) {
    const lines = [""];
    for (const word of words.split(/(?<=[ ·,/])/)) {
      const last = lines[lines.length - 1];
      if (last === "" || widthOf((last + word).trimEnd(), style) <= width) lines[lines.length - 1] = last + word;
      else lines.push(word);
    }
    return lines.map((line) => cutTo(line.trimEnd(), width, style));
  }

  // Keeps where words stand, [words, left, top, right, bottom], so that it can be told whether they lie on each other.
  class Pen {
    constructor(paint = (colour) => colour) {
      this.paint = paint;
      this.words = [];
    }
    text(words, x, y, style = {}) {
      if (!words) return;
      const {align = "left", base = "middle", size = 12, turned} = style, wide = widthOf(words, style),
                                                         left = x - {left: 0, center: 0.5, right: 1}[align] * wide,
                                                         top = y - {top: 0, middle: 0.5, bottom: 1}[base] * size;
      this.words.push(
          turned ? [words, x - 0.5 * size, y - 0.5 * wide, x + 0.5 * size, y + 0.5 * wide] :
                   [words, left, top, left + wide, top + size]);
      this.write(words, x, y, {align, base, size, ...style});
    }
  }

  class CanvasPen extends Pen {
    constructor(context, paint) {
      super(paint);
      this.context = context;
    }
    apply({fill, stroke, width = 1, dash = [], cap = "butt", opacity = 1}, shape) {
      const c = this.context;
      c.globalAlpha = opacity;
      if (fill) {
        c.fillStyle = this.paint(fill);
        c.fill(shape);
      }
      if (stroke) {
        c.strokeStyle = this.paint(stroke);
        c.lineWidth = width;
        c.lineCap = cap;
        c.lineJoin = "round";
        c.setLineDash(dash);
        c.stroke(shape);
      }
      c.globalAlpha = 1;
    }
    path(d, style) { this.apply(style, new Path2D(d)); }
    rect(x, y, width, height, style) {
      const shape = new Path2D();
      shape.rect(x, y, width, height);
      this.apply(style, shape);
    }
    // One shape at many places [x, y, x, y, …].
    stamps(d, places, style) {
      const c = this.context, shape = new Path2D(d), own = c.getTransform();
      for (let i = 0; i < places.length; i += 2) {
        c.translate(places[i], places[i + 1]);
        this.apply(style, shape);
        c.setTransform(own);
      }
    }
    // Squares, however many.
    squares(places, size, colour) {
      const c = this.context;
      c.fillStyle = this.paint(colour);
      for (let i = 0; i < places.length; i += 2)
        c.fillRect(places[i] - 0.5 * size, places[i + 1] - 0.5 * size, size, size);
    }
    write(words, x, y, {align, base, colour = "#333333", turned, halo, ...font}) {
      const c = this.context;
      c.save();
      c.font = fontOf(font);
      c.textAlign = align;
      c.textBaseline = base;
      c.translate(x, y);
      if (turned) c.rotate(-Math.PI / 2);
      if (halo) {
        c.strokeStyle = this.paint("#ffffff");
        c.lineWidth = 3;
        c.lineJoin = "round";
        c.strokeText(words, 0, 0);
      }
      c.fillStyle = this.paint(ricochet.theme.letters(colour));
      c.fillText(words, 0, 0);
      c.restore();
    }
    image(canvas, x, y, width, height) {
      this.context.imageSmoothingEnabled = false;
      this.context.drawImage(canvas, x, y, width, height);
    }
    within({x, y, width, height}, draw) {
      this.context.save();
      this.context.beginPath();
      this.context.rect(x, y, width, height);
      this.context.clip();
      draw();
      this.context.restore();
    }
  }

  class SvgPen extends Pen {
    constructor(size) {
      super();
      Object.assign(this, {size, out: [], clips: 0});
    }
    style({fill, stroke, width = 1, dash = [], cap, opacity}) {
      return ' fill="' + (fill || "none") + '"' +
          (stroke ? ' stroke="' + stroke + '" stroke-width="' + width + '" stroke-linejoin="round"' : "") +
          (dash.length ? ' stroke-dasharray="' + dash.join(" ") + '"' : "") +
          (cap ? ' stroke-linecap="' + cap + '"' : "") +
          (opacity !== undefined && opacity !== 1 ? ' opacity="' + opacity + '"' : "");
    }
    path(d, style) {
      if (d) this.out.push('<path d="' + d + '"' + this.style(style) + "/>");
    }
    rect(x, y, width, height, style) {
      this.out.push(
          '<rect x="' + short(x) + '" y="' + short(y) + '" width="' + short(width) + '" height="' + short(height) +
          '"' + this.style(style) + "/>");
    }
    stamps(d, places, style) {
      this.out.push("<g" + this.style(style) + ">");
      for (let i = 0; i < places.length; i += 2)
        this.out.push(
            '<path d="' + d + '" transform="translate(' + short(places[i]) + " " + short(places[i + 1]) + ')"/>');
      this.out.push("</g>");
    }
    // Many squares are a picture: a file of a hundred thousand shapes opens slowly.
    squares(places, size, fill) {
      if (places.length > 8000) {
        const fine = 2, {width, height} = this.size,
              canvas = Object.assign(document.createElement("canvas"), {width: fine * width, height: fine * height}),
              context = canvas.getContext("2d");
        context.scale(fine, fine);
        new CanvasPen(context).squares(places, size, fill);
        this.image(canvas, 0, 0, width, height);
        return;
      }
      let d = "";
      for (let i = 0; i < places.length; i += 2)
        d += "M" + short(places[i] - 0.5 * size) + " " + short(places[i + 1] - 0.5 * size) + "h" + size + "v" + size +
            "h-" + size + "z";
      this.path(d, {fill});
    }
    write(words, x, y, {align, base, colour = "#333333", turned, halo, size, bold}) {
      const anchor = {left: "start", center: "middle", right: "end"}[align],
            down = {top: 0.8, middle: 0.35, bottom: -0.15}[base] * size;
      this.out.push(
          '<text x="' + short(x) + '" y="' + short(turned ? y : y + down) + '" font-size="' + size + '" text-anchor="' +
          anchor + '" fill="' + ricochet.theme.letters(colour) + '"' + (bold ? ' font-weight="bold"' : "") +
          (halo ? ' stroke="#ffffff" stroke-width="3" stroke-linejoin="round" paint-order="stroke"' : "") +
          (turned ? ' transform="rotate(-90 ' + short(x) + " " + short(y) + ')" dy="' + short(down) + '"' : "") + ">" +
          ricochet.format.escape(words) + "</text>");
    }
    image(canvas, x, y, width, height) {
      this.out.push(
          '<image preserveAspectRatio="none" style="image-rendering:pixelated" x="' + short(x) + '" y="' + short(y) +
          '" width="' + short(width) + '" height="' + short(height) + '" href="' + canvas.toDataURL() + '"/>');
    }
    within({x, y, width, height}, draw) {
      const id = "clip" + ++clips;
      this.out.push('<clipPath id="' + id + '">');
      this.rect(x, y, width, height, {fill: "#000000"});
      this.out.push('</clipPath><g clip-path="url(#' + id + ')">');
      draw();
      this.out.push("</g>");
    }
    get svg() {
      const {width, height} = this.size;
      return '<svg width="' + width + '" height="' + height + '" viewBox="0 0 ' + width + " " + height +
          '" font-family="' + family + '">' + this.out.join("") + "</svg>";
    }
  }
  let clips = 0;  // of the whole page: ids stand once
  const short = (value) => String(Math.round(100 * value) / 100);

  Object.assign(ricochet, {CanvasPen, SvgPen, widthOf, cutTo, linesOf});
}

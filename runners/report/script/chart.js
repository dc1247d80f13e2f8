// A chart of the page: a canvas in its place, and a reader's hands on it. A drag shows a part, a double click all;
// Shift
// + wheel and Alt + wheel zoom along x and y. Hovering says what lies there, a click opens it.
{
  const reach = {hover: 9, click: 14};
  const tip = Object.assign(document.createElement("div"), {className: "orbit-tip"});
  // What is said beside a place of the screen; nothing where there is none.
  function say(html, [x, y] = [0, 0]) {
    if (!html) return tip.remove();
    tip.innerHTML = html;
    if (!tip.isConnected) document.body.append(tip);
    const {width, height} = tip.getBoundingClientRect(),
                  fits = (at, size, most) => Math.max(0, at + 14 + size < most ? at + 14 : at - 14 - size);
    tip.style.left = fits(x, width, window.innerWidth) + "px";
    tip.style.top = fits(y, height, window.innerHeight) + "px";
  }
  // Not so near that numbers are not told apart.
  const finite = ([a, b]) =>
      Number.isFinite(a) && Number.isFinite(b) && b - a > 1e-10 * Math.max(Math.abs(a), Math.abs(b));

  class Chart {
    // `told` {zoomed(chart), reset()}: the figure that the chart belongs to hears of both.
    constructor(element, told = {}) {
      Object.assign(this, {element, told, windows: {x: null, y: null}, hidden: new Set(), view: null});
      this.canvas = document.createElement("canvas");
      this.guide = Object.assign(document.createElement("div"), {className: "guide", hidden: true});
      element.replaceChildren(this.canvas, this.guide);
      this.unhear = new AbortController();
      const hear = (name, action, where = this.canvas, more = {}) =>
          where.addEventListener(name, action, {signal: this.unhear.signal, ...more});
      hear("pointermove", (event) => this.moved(event));
      hear("pointerleave", () => this.rest());
      hear("pointerdown", (event) => this.pressed(event));
      hear("pointerup", (event) => this.released(event));
      hear("dblclick", () => (this.told.reset || (() => this.zoom({x: null, y: null})))());
      hear("wheel", (event) => this.wheeled(event), this.canvas, {passive: false});
      ricochet.theme.follow(this);
    }
    show(view, hidden = new Set()) {
      Object.assign(this, {view, hidden});
      this.draw();
    }
    draw() {
      const {element, canvas, view, hidden, windows} = this, fine = window.devicePixelRatio || 1,
                                            width = element.clientWidth, height = element.clientHeight;
      canvas.width = Math.max(1, Math.round(width * fine));
      canvas.height = Math.max(1, Math.round(height * fine));
      canvas.style.cssText = "display:block;width:" + width + "px;height:" + height + "px";
      if (!view) return;
      const context = canvas.getContext("2d");
      context.scale(fine, fine);
      this.plot = new ricochet.Plot(view, {width, height}, {hidden, windows});
      this.plot.draw(new ricochet.CanvasPen(context, ricochet.theme.colour));
    }
    zoom(windows, quiet = false) {
      Object.assign(this.windows, windows);
      this.draw();
      if (!quiet && this.told.zoomed) this.told.zoomed(this);
    }
    dispose() {
      this.unhear.abort();
      ricochet.theme.forget(this);
      this.element.replaceChildren();
      this.view = null;
      say("");
    }

    place({offsetX, offsetY}) { return [offsetX, offsetY]; }
    mark(left, top, width, height, classes) {
      Object.assign(this.guide, {hidden: false, className: "guide " + classes});
      this.guide.style.cssText = "left:" + left + "px;top:" + top + "px;width:" + width + "px;height:" + height + "px";
    }
    rest() {
      if (!this.from) this.guide.hidden = true;
      say("");
    }
    moved(event) {
      if (!this.view) return;
      const place = this.place(event);
      if (this.from && event.pointerType === "mouse") this.dragged(place);
      else this.hover(place, [event.clientX, event.clientY]);
    }
    // What is said of a place.
    words(place) {
      const {plot, view} = this, frame = plot.frames[plot.frameAt(place)];
      if (!frame) return "";
      if (view.along) {
        const found = plot.along(place[0]);
        if (found.length) this.mark(plot.xs[0].at(found[0].x), frame.y, 0, frame.height, "along");
        return found.length ? ricochet.pointWords(view, found) : "";
      }
      const found = plot.at(place, reach.hover);
      this.guide.hidden = true;
      if (!found) return "";
      this.canvas.style.cursor = view.open || found.row.case || found.mark.case ? "pointer" : "";
      return (view.words || ((one) => ricochet.pointWords(view, [one])))(found);
    }
    hover(place, where) {
      this.canvas.style.cursor = "";
      say(this.words(place), where);
    }
    pressed(event) {
      if (event.button !== 0 || event.pointerType !== "mouse" || !this.view) return;
      const frame = this.plot.frameAt(this.place(event));
      if (frame < 0) return;
      this.from = {place: this.place(event), at: this.place(event)[0], frame, pan: event.shiftKey};
      this.canvas.setPointerCapture(event.pointerId);
      event.preventDefault();
      this.element.focus({preventScroll: true});
    }
    // The part of the axes between two places; of y where the drag is tall and the chart is one that zooms so.
    part({place: [ax, ay], frame: own}, [bx, by]) {
      const {plot, view} = this, frame = plot.frames[own],
                   clip = (value, low, size) => Math.min(Math.max(value, low), low + size);
      const left = clip(Math.min(ax, bx), frame.x, frame.width), right = clip(Math.max(ax, bx), frame.x, frame.width),
            tall = Math.abs(ay - by) > 24 && !view.along && plot.frames.filter(({pad}) => !pad).length === 1 &&
          view.yAxes[0].type !== "category";
      return {
        left,
        right,
        tall,
        top: tall ? clip(Math.min(ay, by), frame.y, frame.height) : frame.y,
        bottom: tall ? clip(Math.max(ay, by), frame.y, frame.height) : frame.y + frame.height
      };
    }
    dragged(place) {
      const {from, plot} = this;
      say("");
      if (from.pan) {
        const [x] = plot.xs, shift = place[0] - from.at,
              next = [x.axis.min, x.axis.max].map((value) => x.value(x.at(value) - shift));
        from.at = place[0];
        if (finite(next)) this.zoom({x: next});
        return;
      }
      const {left, right, top, bottom} = this.part(from, place);
      if (Math.abs(place[0] - from.place[0]) > 4) this.mark(left, top, right - left, bottom - top, "brush");
    }
    released(event) {
      const {from} = this, place = this.place(event);
      this.from = null;
      this.guide.hidden = true;
      if (!this.view || event.button !== 0) return;
      if (from && Math.abs(place[0] - from.place[0]) > 4) {
        if (from.pan) return;
        const {left, right, tall, top, bottom} = this.part(from, place), [x] = this.plot.xs, [y] = this.plot.ys;
        const along = [x.value(left), x.value(right)].sort((a, b) => a - b), up = [y.value(bottom), y.value(top)];
        if (finite(along)) this.zoom({x: along, ...(tall && finite(up) ? {y: up} : {})});
      } else this.pick(place);
    }
    pick(place) {
      const {view, plot} = this,
                   found = view.open ?
          plot.at(place, reach.click) :
          plot.at(
              place, reach.click, ({rows, case: id}) => id || (Array.isArray(rows) && rows.some((row) => row.case)));
      if (found && view.open) view.open(found);
      else if (found && (found.row.case || found.mark.case))
        ricochet.showCase(ricochet.data, found.row.case || found.mark.case);
      return Boolean(found);
    }
    wheeled(event) {
      if (!this.view || !(event.shiftKey || event.altKey) || this.plot.frameAt(this.place(event)) < 0) return;
      event.preventDefault();
      const along = event.altKey ? "y" : "x", scale = this.plot[along + "s"][0],
            factor = (event.deltaY || event.deltaX) > 0 ? 1.25 : 0.8, at = this.place(event)[along === "x" ? 0 : 1];
      if (scale.axis.type === "category") return;
      const next = [scale.axis.min, scale.axis.max].map((value) => scale.value(at + factor * (scale.at(value) - at)));
      if (finite(next)) this.zoom({[along]: next});
    }
  }

  // What is said of points: one x over all of them, a line each.
  ricochet.pointWords = (view, found) => {
    const {escape, shown, unit} = ricochet.format,
                          value = (known, quantity) =>
                              (typeof known === "string" ? known : shown(known, 9) + unit(quantity));
    const row = ({mark, row, y}) => '<div class="tip-row"><span class="swatch" style="background:' +
        ricochet.theme.colour(typeof mark.colour === "function" ? mark.colour(row) : mark.colour) + '"></span>' +
        escape(mark.name) +
        (row.text ? '</div><div class="tip-text">' + escape(row.text) + "</div>" :
                    "<b>" + escape(value(y, view.y)) + "</b></div>");
    const [first] = found,
          head = first.mark.apart || first.x === null ? "" :
                                                        "<div>" + escape(view.x[0]) + " = " +
            escape(value(typeof first.x === "number" ? Number(first.x.toPrecision(7)) : first.x, view.x)) + "</div>";
    const cases = ricochet.distinct(found.map((one) => one.row.case || one.mark.case).filter(Boolean)),
          named = cases.length ? '<div class="fine">' + (cases.length > 1 ? "cases " : "case ") +
            escape(cases.join(", ")) + "; click: all of it</div>" :
                                 "";
    return head + '<div class="fine">' + escape(view.y[0]) + "</div>" + found.map(row).join("") + named;
  };
  Object.assign(ricochet, {Chart, tip: say});
}

// The displacement of a structure over time and place as a picture: blue below, red above, a mark where a contact point
// is pushed.
{
  const margin = {left: 56, right: 14, top: 8, bottom: 34};
  const below = [5, 98, 160], above = [190, 60, 8], middle = [247, 247, 247];

  function shade(share) {
    const end = share < 0 ? below : above, size = Math.min(1, Math.abs(share));
    return middle.map((value, c) => Math.round(value + size * (end[c] - value)));
  }
  // One pixel per instant and place; where instants are not evenly spaced they are as the film has them.
  function picture(shots, largest) {
    const image = document.createElement("canvas"), places = shots.x.length;
    image.width = shots.count;
    image.height = places;
    const context = image.getContext("2d"), pixels = context.createImageData(shots.count, places);
    for (let k = 0; k < shots.count; ++k)
      for (let place = 0; place < places; ++place) {
        const [r, g, b] = shade(shots.at(k, place) / largest), at = 4 * ((places - 1 - place) * shots.count + k);
        pixels.data.set([r, g, b, 255], at);
      }
    context.putImageData(pixels, 0, 0);
    return image;
  }

  class SpaceTime {
    constructor(canvas, shots, largest) {
      Object.assign(this, {canvas, shots, largest, image: picture(shots, largest)});
    }
    frame(width, height) {
      return {
        x: margin.left,
        y: margin.top,
        width: width - margin.left - margin.right,
        height: height - margin.top - margin.bottom
      };
    }
    // The instant under a place of the canvas.
    instant(offsetX) {
      const {width, height} = this.canvas.getBoundingClientRect(), frame = this.frame(width, height);
      return Math.max(
          0, Math.min(this.shots.count - 1, Math.floor(this.shots.count * (offsetX - frame.x) / frame.width)));
    }
    draw(k) {
      const {context, width, height, ink} = ricochet.freshCanvas(this.canvas), {shots} = this,
                                     frame = this.frame(width, height), {shown} = ricochet.format;
      const across = (instant) => frame.x + frame.width * (instant + 0.5) / shots.count, length = shots.length || 1,
            share = (point) =>
                (shots.names    ? (shots.stops[point].at + 0.5) / shots.x.length :
                     shots.mass ? 0.5 :
                                  shots.point[point] / length);
      const up = (point) => frame.y + frame.height * (1 - share(point));
      context.clearRect(0, 0, width, height);
      context.imageSmoothingEnabled = false;
      context.drawImage(this.image, frame.x, frame.y, frame.width, frame.height);
      const wide = Math.max(2, frame.width / shots.count), points = shots.point.length;
      let marks = 0;
      context.fillStyle = "#111";
      for (const entry of shots.pushed) {
        const instant = Math.floor(entry / points), point = entry % points;
        context.fillRect(across(instant) - 0.5 * wide, up(point) - 2.5, wide, 5);
        ++marks;
      }
      this.canvas.dataset.marks = String(marks);
      context.strokeStyle = ink;
      context.strokeRect(frame.x, frame.y, frame.width, frame.height);
      context.beginPath();
      context.moveTo(across(k), frame.y - 4);
      context.lineTo(across(k), frame.y + frame.height + 4);
      context.lineWidth = 1.5;
      context.stroke();
      context.fillStyle = ink;
      context.textBaseline = "top";
      for (const [instant, align] of [[0, "left"], [shots.count - 1, "right"]]) {
        context.textAlign = align;
        context.fillText(
            shown(shots.t[instant], 4), instant ? frame.x + frame.width : frame.x, frame.y + frame.height + 6);
      }
      context.textAlign = "center";
      context.fillText(
          shots.y ? "t (s), u" + shots.axes[shots.shown] : "t (s)", frame.x + 0.5 * frame.width,
          frame.y + frame.height + 6);
      if (shots.mass) return;
      context.textAlign = "right";
      const ends = shots.bodies ? [] :
          shots.names           ? [shots.names[shots.names.length - 1], "", shots.names[0]] :
                                  [shown(length, 4), "x (m)", "0"],
            lines = ["top", "middle", "bottom"];
      ends.forEach((words, end) => {
        context.textBaseline = lines[end];
        context.fillText(words, frame.x - 6, frame.y + 0.5 * end * frame.height, margin.left - 8);
      });
      context.textBaseline = "middle";
      const row = (place) => frame.y + frame.height * (1 - place / shots.x.length);
      (shots.bodies ?? []).forEach(({name, first}, b) => {
        const next = shots.bodies[b + 1]?.first ?? shots.x.length;
        context.fillText(name, frame.x - 6, 0.5 * (row(first) + row(next)), margin.left - 8);
        if (b) context.fillRect(frame.x, row(first) - 0.5, frame.width, 1);
      });
    }
  }

  ricochet.SpaceTime = SpaceTime;
  // The colours of the map, from −largest to largest, as a style.
  ricochet.spaceTimeColours = "linear-gradient(to right, " +
      [-1, -0.5, 0, 0.5, 1].map((share) => "rgb(" + shade(share).join(",") + ")").join(", ") + ")";
}

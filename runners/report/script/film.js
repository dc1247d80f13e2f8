// See it move: the film of one case, or of two over each other or side by side. A map shows each over time and place.
// The slider is the time of all.
{
  const colours = ["#0072B2", "#D55E00"], lengths = [5, 10, 20, 40, 80];  // s that a whole film takes
  const calm = () => window.matchMedia("(prefers-reduced-motion: reduce)").matches;
  const calmInstant = 0.5;  // s, where motion is to be reduced

  const {escape} = ricochet.format;
  const nameOf = (data, one) => [data.view.label(one) || "the one case", one.id, data.page.snapshots.cases[one.id].of]
                                    .filter(Boolean)
                                    .join(" · ");

  // The case that differs from the first in a method, and in as little else as there is.
  function otherMethod(view, [first, ...others]) {
    const differing = (one) =>
        view.varying.filter((column) => ricochet.textOf(one, column) !== ricochet.textOf(first, column));
    const {isMethod} = ricochet,
          cost = (one) => differing(one).reduce(
              (sum, column) => sum + (isMethod(column) ? 1 : 100), differing(one).some(isMethod) ? 0 : 10000);
    return others.filter((one) => one.status === "done").sort((a, b) => cost(a) - cost(b))[0];
  }

  function sectionOf(data, cases) {
    const section = document.createElement("section"),
          option = (one) => '<option value="' + escape(one.id) + '">' + escape(nameOf(data, one)) + "</option>",
          options = cases.map(option).join("");
    const {stride} = data.page.snapshots,
          more = cases.length < data.cases.length ?
        " " + cases.length + " of " + data.cases.length + " cases have one." :
        "";
    section.id = "film";
    section.innerHTML = "<h2>See it move</h2>" +
        '<p class="caption">Each case at its instants. Arrows: what the stops push with, the mean since the instant ' +
        'before. Space plays and stops, ← and → go one instant on.' + more +
        (stride > 1 ? " Of every " + stride + " instants that are kept one is shown here." : "") + "</p>" +
        '<div class="controls"><label>Case <select data-film="first">' + options +
        '</select></label><label>with <select data-film="second"><option value="">none</option>' + options +
        '</select></label><label><input type="checkbox" data-film="overlay" checked> over each other</label></div>' +
        '<div class="film-keys"><button type="button" data-film="play" aria-label="play">▶</button>' +
        '<input type="range" data-film="time" min="0" step="1" value="0" aria-label="time">' +
        '<label>whole in <select data-film="length">' +
        lengths.map((s) => '<option value="' + s + '"' + (s === 20 ? " selected" : "") + ">" + s + " s</option>")
            .join("") +
        "</select></label></div>" +
        '<p class="film-now" data-film="now" aria-live="off"></p>' +
        '<canvas class="film-stage" data-film="stage" tabindex="0" role="img" aria-label="The motion at the chosen ' +
        'time"></canvas><p class="fine" data-film="scale"></p>' +
        '<h3>Displacement over time and place</h3>' +
        '<p class="caption">Black: a contact point is pushed. A click goes to that time. <span class="film-colours" ' +
        'style="background:' + ricochet.spaceTimeColours + '"></span> <span data-film="colours"></span></p>' +
        '<div data-film="maps"></div>';
    return section;
  }

  class Film {
    constructor(data, cases, section) {
      Object.assign(this, {data, cases, section, k: 0, playing: 0, maps: [], known: new Map()});
      for (const part of section.querySelectorAll("[data-film]")) this[part.dataset.film] = part;
      const second = otherMethod(data.view, cases);
      if (second) this.second.value = second.id;
      for (const part of [this.first, this.second]) part.addEventListener("change", () => this.load());
      this.overlay.addEventListener("change", () => this.draw());
      this.play.addEventListener("click", () => this.toggle());
      this.time.addEventListener("input", () => this.go(Number(this.time.value)));
      section.addEventListener("keydown", (event) => this.key(event));
      const later = new IntersectionObserver((entries) => {
        if (entries.some((one) => one.isIntersecting)) {
          later.disconnect();
          this.load();
        }
      }, {rootMargin: "400px"});
      later.observe(section);
      window.addEventListener("resize", () => this.films && this.draw());
    }
    shots(id) {
      if (!this.known.has(id)) this.known.set(id, new ricochet.Snapshots(this.data, this.data.byId.get(id)));
      return this.known.get(id);
    }
    has(id) { return this.cases.some((one) => one.id === id); }
    choose(id) {
      this.first.value = id;
      if (this.second.value === id) this.second.value = "";
      this.load();
      this.section.scrollIntoView({behavior: calm() ? "auto" : "smooth"});
    }
    load() {
      const ids = ricochet.distinct([this.first.value, this.second.value].filter(Boolean));
      this.films = ids.map((id, f) => ({
                             shots: this.shots(id),
                             colour: colours[f],
                             dash: f ? [8, 5] : [],
                             name: nameOf(this.data, this.data.byId.get(id))
                           }));
      const largest = Math.max(...this.films.map(({shots}) => shots.largest), 1e-300), {text} = ricochet.format;
      this.time.max = String(this.films[0].shots.count - 1);
      this.colours.textContent = text(-largest, 3) + " to " + text(largest, 3) + " m";
      this.section.querySelector('[data-film="maps"]').replaceChildren(...this.films.map(({name, colour}) => {
        const box = document.createElement("figure"), caption = document.createElement("figcaption"),
              canvas = document.createElement("canvas");
        caption.textContent = name;
        caption.className = "film-name";
        caption.dataset.colour = colour;
        canvas.className = "film-map";
        canvas.setAttribute("role", "img");
        canvas.setAttribute("aria-label", "Displacement over time and place: " + name);
        box.append(caption, canvas);
        return box;
      }));
      this.maps = Array.from(this.section.querySelectorAll(".film-map"), (canvas, f) => {
        const map = new ricochet.SpaceTime(canvas, this.films[f].shots, largest),
              jump = (event) => this.goTo(map.shots.t[map.instant(event.offsetX)]);
        canvas.addEventListener("pointerdown", jump);
        canvas.addEventListener("pointermove", (event) => {
          if (event.buttons & 1) jump(event);
        });
        return map;
      });
      this.k = Math.min(this.k, this.films[0].shots.count - 1);
      this.paint();
      this.go(this.k);
    }
    // In the colours of what it is seen on.
    paint() {
      if (!this.films) return;
      this.section.querySelectorAll(".film-name").forEach((name) => {
        name.style.color = ricochet.theme.colour(name.dataset.colour);
      });
      this.draw();
    }
    goTo(time) { this.go(this.films[0].shots.nearest(time)); }
    go(k) {
      const {count} = this.films[0].shots;
      this.k = Math.max(0, Math.min(count - 1, k));
      this.time.value = String(this.k);
      this.draw();
    }
    draw() {
      const time = this.films[0].shots.t[this.k], {text, shown} = ricochet.format;
      for (const film of this.films) film.k = film.shots === this.films[0].shots ? this.k : film.shots.nearest(time);
      this.scale.textContent = ricochet.drawStage(
          this.stage, this.films.map((film) => ({...film, colour: ricochet.theme.colour(film.colour)})),
          this.overlay.checked);
      this.maps.forEach((map, f) => map.draw(this.films[f].k));
      const words = this.films.map(
          ({shots, k}) =>
              shots.said(k, text) + (shots.contacts(k).length ? ", pushed at " + shots.contacts(k).length : ""));
      this.now.textContent = "t = " + shown(time, 5) + " s: " + words.join(" · ");
      this.time.setAttribute("aria-valuetext", this.now.textContent);
    }
    // What is shown, to be read by who looks on.
    state() {
      return {
        k: this.k,
        playing: this.playing !== 0,
        films: this.films.map(({shots, k}) => ({
                                id: shots.one.id,
                                t: shots.t[k],
                                tip: shots.tip(k),
                                unit: shots.metres,
                                contacts: shots.contacts(k).length
                              }))
      };
    }

    toggle() {
      if (this.playing) this.stop();
      else this.start();
    }
    start() {
      if (!this.films) this.load();
      const {count} = this.films[0].shots;
      if (this.k >= count - 1) this.go(0);
      this.play.textContent = "❚❚";
      this.play.setAttribute("aria-label", "stop");
      let last = performance.now(), due = 0;
      const tick = () => {
        const now = performance.now(), instant = calm() ? calmInstant : Number(this.length.value) / count;
        due += (now - last) / 1000 / instant;
        last = now;
        const whole = Math.floor(due);
        due -= whole;
        if (whole > 0) this.go(this.k + whole);
        if (this.k >= count - 1) this.stop();
        else this.playing = requestAnimationFrame(tick);
      };
      this.playing = requestAnimationFrame(tick);
    }
    stop() {
      cancelAnimationFrame(this.playing);
      this.playing = 0;
      this.play.textContent = "▶";
      this.play.setAttribute("aria-label", "play");
    }
    key(event) {
      const native = event.target.matches("select, button, input");
      const step = {ArrowLeft: -1, ArrowRight: 1, Home: -Infinity, End: Infinity}[event.key];
      if (event.key === " " && !event.target.matches("select, button, input[type=checkbox]")) this.toggle();
      else if (step !== undefined && !native) this.go(this.k + step);
      else return;
      event.preventDefault();
    }
  }

  // Makes the film where the page holds snapshots, after a part of the page and its entry in the list of these.
  ricochet.startFilm = (data, after, entry) => {
    const held = (data.page.snapshots || {}).cases, cases = held ? data.cases.filter((one) => held[one.id]) : [];
    if (!cases.length) return;
    const section = sectionOf(data, cases),
          link = Object.assign(document.createElement("a"), {href: "#film", textContent: "See it move"});
    after.after(section);
    entry.after(link);
    ricochet.film = new Film(data, cases, section);
  };
}

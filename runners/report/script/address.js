// What a reader set stands in the address, so that it can be sent: #figure-energy?view=1&hide=β 0.25&from=0.1&to=0.2,
// #all-cases?filter=status = done. What was set elsewhere before follows as `also`, each once more such a text. Opened
// again, the page shows it all, at the place of the last.
{
  const set = new Map();  // id → its words, the last that was set at the end
  function put(id, said) {
    const words = Object.entries(said).filter(([, value]) => value !== "" && value !== null && value !== 0);
    set.delete(id);
    const also = Array.from(set).reverse();
    if (words.length) set.set(id, new URLSearchParams(words));
    for (const [other, its] of also) words.push(["also", other + "?" + its]);
    history.replaceState(null, "", "#" + id + (words.length ? "?" + new URLSearchParams(words) : ""));
  }
  const figureOf = (id) => ricochet.figures.find(({section}) => section.id === id);
  // Shows what was set at one place.
  function apply(id, said) {
    const figure = figureOf(id), filter = said.get("filter");
    if (figure) {
      for (const name of (said.get("hide") || "").split("\n").filter(Boolean)) figure.hide(name);
      figure.own = said.get("own") === "yes";
      figure.section.querySelectorAll("[data-own]").forEach((box) => (box.checked = figure.own));
      if (said.has("from")) figure.zoom = [Number(said.get("from")), Number(said.get("to"))];
      figure.show(Math.min(Number(said.get("view") || 0), figure.description.views.length - 1));
    }
    if (filter) {
      ricochet.later.fillAll();
      document.getElementById("filter").value = filter;
      document.getElementById("filter").dispatchEvent(new Event("input"));
    }
  }
  // A text of the address: its place, and what was set there.
  function parts(text) {
    const [id, ...words] = text.split("?");
    return [decodeURIComponent(id), new URLSearchParams(words.join("?"))];
  }
  ricochet.address = {
    ofFigure({section, view, hidden, zoom, own}) {
      const [from, to] = zoom || ["", ""];
      put(section.id, {view, hide: Array.from(hidden).join("\n"), from, to, own: own ? "yes" : ""});
    },
    ofCases: (filter) => put("all-cases", {filter}),
    // Once all figures are there.
    open() {
      const [id, said] = parts(location.hash.slice(1)), words = said.toString(),
                 place = id && (figureOf(id)?.section || document.getElementById(id)),
                 all = said.getAll("also").reverse().map(parts);
      said.delete("also");
      for (const [one, its] of all.concat([[id, said]])) {
        if (!its.toString()) continue;
        set.set(one, its);
        apply(one, its);
      }
      if (place && (figureOf(id) || words)) place.scrollIntoView();
    }
  };
}

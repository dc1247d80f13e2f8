// What a reader set stands in the address, so that it can be sent: #figure-energy?view=1&hide=β 0.25&from=0.1&to=0.2,
// #all-cases?filter=status = done. Opened again, the page shows it.
{
  const put = (id, said) => {
    const words = Object.entries(said).filter(([, value]) => value !== "" && value !== null && value !== 0);
    history.replaceState(null, "", "#" + id + (words.length ? "?" + new URLSearchParams(words) : ""));
  };
  ricochet.address = {
    ofFigure({section, view, hidden, zoom, own}) {
      const [from, to] = zoom || ["", ""];
      put(section.id, {view, hide: Array.from(hidden).join("\n"), from, to, own: own ? "yes" : ""});
    },
    ofCases: (filter) => put("all-cases", {filter}),
    // Once all figures are there.
    open() {
      const [id, words = ""] = location.hash.slice(1).split("?"), said = new URLSearchParams(words),
                         figure = ricochet.figures.find(({section}) => section.id === decodeURIComponent(id)),
                         place = id && (figure ? figure.section : document.getElementById(decodeURIComponent(id))),
                         filter = said.get("filter");
      if (figure && words) {
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
      if (place && (figure || words)) place.scrollIntoView();
    }
  };
}

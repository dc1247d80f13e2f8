// A map of cases or a table of a thousand rows is long to lay out. It waits until the reader comes near, searches
// (Ctrl+F, F3) or prints. Such a table stands in the page as <noscript class="later">. A browser that runs scripts
// reads it as one text; one that runs none shows the table.
{
  const waiting = new Map();
  const near = new IntersectionObserver((entries) => {
    for (const entry of entries)
      if (entry.isIntersecting) fill(entry.target);
  }, {rootMargin: "600px"});

  function fill(place) {
    const make = waiting.get(place);
    if (!make) return;
    waiting.delete(place);
    near.unobserve(place);
    make();
  }
  const later = ricochet.later = {
    fill,
    fillAll() {
      for (const place of Array.from(waiting.keys()))
        if (place.isConnected) fill(place);
    },
    waits: (place) => waiting.has(place),
    // Has `make` fill a place when its time has come.
    wait(place, make) {
      waiting.set(place, make);
      near.observe(place);
    },
    // Tables that stand as text; `begin` works on what then stands there.
    startTables(begin) {
      for (const text of document.querySelectorAll("noscript.later")) {
        const place = Object.assign(document.createElement("div"), {className: "waits"});
        text.replaceWith(place);
        later.wait(place, () => {
          const made = document.createElement("template");
          made.innerHTML = text.textContent;
          const parts = Array.from(made.content.children);
          place.replaceWith(made.content);
          parts.forEach(begin);
        });
      }
    },
  };
  window.addEventListener("beforeprint", () => later.fillAll());
  document.addEventListener("keydown", (event) => {
    if (event.key === "F3" || ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "f")) later.fillAll();
  });
}

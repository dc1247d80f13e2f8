// Words that judge, each with a "?" beside it that says what it means: one table for the whole page. It works by
// keyboard and touch, and without it nothing is lost.
{
  const meanings = {
    "decides in part":
        "The choice decides in some combinations of the others and not in all. Where one other choice tells in " +
        "which, it is named.",
    "does not matter":
        "The difference that this choice makes and what step and mesh leave open are both within 1 %. Take what is " +
        "cheapest.",
    decides:
        "Levels of this choice differ by more than 1 % and by more than twice what step and mesh leave open. The " +
        "difference is one of the methods, not of the refinement.",
    "is not resolved":
        "What step and mesh leave open is as large as what the choice changes. Nothing is known until they are " +
        "refined.",
    "not resolved":
        "What step and mesh leave open is as large as what the choice changes. Nothing is known until they are " +
        "refined.",
    "not told": "With one step and one mesh nothing says how much these change. A second step or mesh would.",
    "not observed":
        "All values are 0 or below what round-off can make. No difference, order or share is read from them.",
    settles: "The moves from one step to the next finer one shrink. The value near which they end is meant.",
    "keeps moving": "The moves from one step to the next do not shrink. The finest value is no limit yet.",
    "moves more and more":
        "The moves from one step to the next grow. Refining leads away from what was found, and not to it.",
    "no steady trend":
        "The moves from one step to the next neither shrink nor grow steadily. The range over all steps is given.",
    "vanishes under refinement":
        "Coarse cases show it and none of the finest does. It is taken for an artefact of step or mesh.",
    confirmed:
        "The fitted order agrees with what the scheme declares. Its 95 % interval, or a slack of a tenth of an " +
        "order, holds the declared one.",
    refuted: "The fitted order is not what the scheme declares. Enough points follow the fitted line to say so.",
    undecided:
        "The data do not tell. Too few points, too wide an interval, or a motion without a class that was found.",
    robust:
        "Every case of the study finds the same classes and the same branches. No numerical choice changes what the " +
        "motion is.",
    "depends on":
        "Cases differ, and the choice that is named tells them apart. The motion is that choice's, not the beam's.",
    depends:
        "It is so in some combinations of the other choices and not in others. The column beside it names what tells " +
        "them apart, where one choice does.",
    "common to all": "Every method that was compared finds it. It is taken for a motion of the beam itself.",
    "not compared": "Too few cases can be compared for a statement. It says nothing about the motion.",
  };
  const words = Object.keys(meanings).sort((a, b) => b.length - a.length),
        pattern = new RegExp("(?<![\\w-])(?:" + words.join("|") + ")(?![\\w-]| apart)", "g");
  let count = 0;

  function explain(button, word) {
    const open = button.getAttribute("aria-expanded") === "true";
    if (open) document.getElementById(button.getAttribute("aria-controls")).remove();
    else {
      const note = Object.assign(
          document.createElement("span"),
          {className: "meaning", id: "meaning-" + ++count, textContent: meanings[word]});
      note.setAttribute("role", "note");
      button.setAttribute("aria-controls", note.id);
      button.closest("td, th, li, p, summary, dd").append(note);
    }
    button.setAttribute("aria-expanded", String(!open));
  }
  function buttonOf(word) {
    const out = Object.assign(document.createElement("button"), {type: "button", className: "why", textContent: "?"});
    out.setAttribute("aria-label", "What “" + word + "” means");
    out.setAttribute("aria-expanded", "false");
    out.addEventListener("click", (event) => {
      event.preventDefault();
      event.stopPropagation();
      explain(out, word);
    });
    return out;
  }
  // Behind each word of a text its button; once in a table, where a word stands in many rows, and once in a sentence.
  function mark(text, told) {
    const found = Array.from(text.data.matchAll(pattern)).filter(([word]) => !told.has(word) && told.add(word));
    for (const {0: word, index} of found.reverse()) text.splitText(index + word.length).before(buttonOf(word));
  }
  ricochet.explainWords = (root) => {
    const walk = document.createTreeWalker(
        root, NodeFilter.SHOW_TEXT,
        (node) =>
            (node.parentElement.closest("td, th, li, p") &&
                     !node.parentElement.closest("button, caption, code, pre, .figure, #all-cases, #tables") ?
                 NodeFilter.FILTER_ACCEPT :
                 NodeFilter.FILTER_REJECT));
    const texts = [], told = new Map();
    while (walk.nextNode()) texts.push(walk.currentNode);
    for (const text of texts) {
      const place = text.parentElement.closest("table") || text.parentElement.closest("li, p");
      if (!told.has(place)) told.set(place, new Set());
      mark(text, told.get(place));
    }
  };
}

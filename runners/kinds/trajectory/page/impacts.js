// How often contact points close, against every axis: a number that grows as the step shrinks is chatter of the method,
// not of the motion.
ricochet.figure("impacts", (data) => ricochet.alongAxes(data, {
  id: "impacts",
  title: "Number of impacts",
  caption:
      "How often a contact point closes over the run, summed over the points. Where the number settles as the step " +
      "shrinks, the impacts are those of the motion; where it grows, the method chatters.",
  values: [
    {view: "impacts", quantity: ["impacts", "1"], logarithmic: false, of: (one) => ricochet.measureOf(one, "impacts")}
  ],
}));

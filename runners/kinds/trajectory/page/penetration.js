// How far a contact point passed its stop, against every axis.
ricochet.figure("penetration", (data) => ricochet.alongAxes(data, {
  id: "penetration", title: "Deepest penetration",
  caption: "The largest distance by which a contact point passed its stop, over every step. 2⁻⁵² of the stop's own position is round-off.",
  values: [{ view: "deepest penetration (m)", quantity: ["deepest penetration", "m"], logarithmic: true, of: (one) => ricochet.measureOf(one, "deepest_penetration") }],
}));

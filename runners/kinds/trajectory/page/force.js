ricochet.figure("force", (data) => ricochet.overTime(data, {
  id: "force",
  title: "Contact force",
  column: "contact_force_peak",
  quantity: ["contact force |p|", "N"],
  scales: ["value"],
  fromZero: true,
  withStops: false,
  measured: {
    values: [{
      view: "peak force (N)",
      quantity: ["peak contact force", "N"],
      of: (one) => ricochet.measureOf(one, "peak_contact_force")
    }]
  },
  caption: "The largest force at one contact point since the sample before, from every step: no peak is lost between " +
      "samples, and forces of opposite stops do not cancel. At rigid stops an impact is an impulse: its force grows " +
      "as the step shrinks.",
}));

#include "runners/kinds/sweep/sweep_keys.hpp"

#include "runners/study/fields.hpp"

namespace ricochet {

std::vector<Field> orbit_keys() {
  using namespace keys;
  ObjectForm transient;
  transient.fields = {
      integer("periods", {1, 100000000, false, false}, 300, "Forcing periods before the first reading."),
      integer("at_most", {1, 100000000, false, false}, 2000,
              "Periods after which an orbit is read though it has not settled.")};
  return {object("transient", Json::object(), "Forcing periods until an orbit has settled.", transient),
          integer("keep", {16, 10000000, false, false}, 300, "Forcing periods that are read."),
          word("section", {"strobe", "impact", "extremum"}, "strobe",
               "When the state is read: each forcing period, at impacts, or at extrema of the tip."),
          single(real("phase", "rad", any, 0.0, "Phase of the forcing at which the strobe reads."))};
}

ObjectForm swept_range(const char* what) {
  using namespace keys;
  ObjectForm keys;
  keys.fields = {single(real("from", "as the parameter", any, std::nullopt, "First value.")),
                 single(real("to", "as the parameter", any, std::nullopt, "Last value.")),
                 integer("count", {2, 1000000, false, false}, std::nullopt, what)};
  return keys;
}

Field swept_pointer() {
  using namespace keys;
  return of_form(
      Field::Form::text, "pointer", std::nullopt,
      "Pointer to a number of the scene (\"/scene/support/amplitude\"; a formula is multiplied by the value) or to a "
      "real parameter of a method (\"/methods/contact/stiffness\").");
}

}  // namespace ricochet

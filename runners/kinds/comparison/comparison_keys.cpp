#include "runners/kinds/comparison/comparison_keys.hpp"

#include <fmt/format.h>

#include "runners/study/fields.hpp"

namespace ricochet {

const std::vector<std::string>& error_names() {
  static const std::vector<std::string> names = {"tip-linf",    "tip-l2", "displacement-l2", "displacement-h2",
                                                 "velocity-l2", "energy", "impact-times",    "impulse"};
  return names;
}

std::vector<Field> comparison_keys() {
  using namespace keys;
  Field reference =
      methods("reference", Role::reference,
              "A reference, \"self\" (the method on finer steps and meshes) or a list, whose first counts; its gap to "
              "the others enters the error floor.");
  reference.marched = true;
  Field errors = of_form(Field::Form::words, "errors", std::nullopt, "Errors.");
  errors.spec = word_parameter("errors", error_names(), std::nullopt, errors.spec.text.c_str());
  errors.fallback = Json(error_names());
  return {step(),
          duration(),
          samples(),
          march("every-step"),
          std::move(reference),
          std::move(errors),
          optional(real("horizon", "s", positive, std::nullopt,
                        "End of the comparison; null: the end, or where two nearby runs have drifted apart.")),
          budget()};
}

void check_comparison(const Json& study) {
  if (const auto horizon = study.find("horizon"); horizon != study.end() && !horizon->is_null())
    if (horizon->get<double>() > study["duration"].get<double>())
      throw InputError("/horizon", fmt::format("a horizon of {} s lies beyond the duration of {} s",
                                               horizon->get<double>(), study["duration"].get<double>()));
}

}  // namespace ricochet

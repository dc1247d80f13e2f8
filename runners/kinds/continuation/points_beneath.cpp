#include "runners/kinds/continuation/points_beneath.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/json/json_text.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/store/atomic_file.hpp"
#include "runners/store/store.hpp"

namespace ricochet {
namespace {

using Json = nlohmann::ordered_json;

const char* const where = "/beneath";

// The scene without what the parameter replaces.
Json fixed_scene(const Json& study, const std::string& pointer) {
  Json fixed = {{"scene", study.at("scene")}};
  const Json::json_pointer place(pointer);
  if (fixed.contains(place)) fixed[place] = nullptr;
  return fixed;
}

StudyResults results_beneath(const Json& study) {
  const auto folder = study.at("beneath").get<std::string>();
  StudyResults results;
  try {
    results = read_store(folder);
  } catch (const StoreError& error) {
    throw InputError(where, error.what());
  }
  const auto refuse = [&](const std::string& what) { throw InputError(where, folder + " " + what); };
  const Json& other = results.study;
  if (results.kind != "bifurcation")
    refuse(fmt::format("holds a study of kind {}; expected bifurcation", results.kind));
  const auto own = study.at("parameter").at("pointer").get<std::string>(),
             theirs = other.at("parameter").at("pointer").get<std::string>();
  if (own != theirs) refuse(fmt::format("goes along {}; expected {}", theirs, own));
  if (other.value("section", "strobe") != "strobe" || other.value("phase", 0.0) != 0)
    refuse(fmt::format("has another section, {} at phase {:g}; expected strobe at phase 0",
                       other.value("section", "strobe"), other.value("phase", 0.0)));
  const Json difference = Json::diff(fixed_scene(study, own), fixed_scene(other, own));
  if (!difference.empty())
    refuse(fmt::format("has another scene: {} differs", difference.front().at("path").get<std::string>()));
  return results;
}

}  // namespace

void check_beneath(const Json& study) {
  if (study.contains("beneath")) results_beneath(study);
}

PointsBeneath points_beneath(const Json& study, std::size_t most) {
  const StudyResults results = results_beneath(study);
  const auto type = points_type();
  std::vector<SectionColumns> all;
  PointsBeneath out;
  for (const CaseRecord& record : results.cases)
    if (const NumberTable* table = type.find(record.numbers)) {
      const SectionColumns columns = type.read(*table);
      if (!columns.parameter || !columns.displacement) continue;
      all.push_back(columns);
      out.stored += columns.parameter->size();
    }
  const std::size_t stride = std::max<std::size_t>(1, (out.stored + most - 1) / std::max<std::size_t>(1, most));
  std::size_t number = 0;
  for (const SectionColumns& columns : all) {
    const std::vector<double>&parameter = *columns.parameter, &tip = *columns.displacement;
    for (std::size_t k = 0; k < parameter.size(); ++k, ++number)
      if (number % stride == 0 && std::isfinite(tip[k])) {
        out.parameter.push_back(parameter[k]);
        out.tip.push_back(tip[k]);
      }
  }
  return out;
}

}  // namespace ricochet

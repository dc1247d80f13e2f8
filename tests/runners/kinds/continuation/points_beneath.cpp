// Points of a bifurcation study beneath branches: which folders are refused, and what is read of the others.
#include "runners/kinds/continuation/points_beneath.hpp"

#include <algorithm>

#include "runners/kinds/stored_study.hpp"
#include "runners/run/run_study.hpp"
#include "tests/runners/kinds/continuation/tube_study.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

// The tube at two amplitudes, marched from rest.
void march_tube(const std::filesystem::path& folder, const Json& change = Json::object()) {
  Json study = tube_continuation();
  for (const char* key : {"orbits", "switch"}) study.erase(key);
  study["kind"] = "bifurcation";
  study["parameter"] = {{"pointer", "/scene/support/amplitude"}, {"values", {0.02, 0.085}}};
  study["transient"] = {{"periods", 5}};
  study["keep"] = 16;
  study["exponents"] = 0;
  study.merge_patch(change);
  static Catalogue catalogue(RICOCHET_PLUGIN_DIR, {}, {});
  Registry registry;
  run_study(parse_study(study.dump(), catalogue, registry), catalogue, registry, {folder, 1, false});
}

}  // namespace

TEST_CASE("points beneath branches are those of the strobe of the same scene") {
  const ScratchFolder folder;
  march_tube(folder / "tube");
  Json study = tube_continuation();
  study["beneath"] = (folder / "tube").string();
  const OpenedContinuation opened = opened_continuation(study);
  // The folder has no part in what the cases compute.
  CHECK(opened.study.cases.front().id == opened_continuation(tube_continuation()).study.cases.front().id);
  const PointsBeneath all = points_beneath(opened.study.resolved, 1000);
  REQUIRE(all.tip.size() == all.stored);
  REQUIRE(all.stored >= 2);
  for (const double value : {0.02, 0.085})
    CHECK(std::find(all.parameter.begin(), all.parameter.end(), value) != all.parameter.end());
  CHECK(points_beneath(opened.study.resolved, 1).tip.size() == 1);
}

TEST_CASE("points of another scene, parameter or section are not drawn beneath branches") {
  const ScratchFolder folder;
  Json study = tube_continuation();
  const auto said = [&](const std::string& name, const Json& change) {
    march_tube(folder / name, change);
    study["beneath"] = (folder / name).string();
    return error_of(study);
  };
  const auto holds = [](const std::string& text, const std::string& part) { return text.find(part) != text.npos; };
  CHECK(holds(said("gap", {{"scene", {{"stops", {{"upper", 0.11}}}}}}), "/beneath: "));
  CHECK(holds(error_of(study), "has another scene: /scene/stops/upper differs"));
  CHECK(holds(said("pulsation", {{"parameter", {{"pointer", "/scene/support/pulsation"}, {"values", {9, 10}}}}}),
              "goes along /scene/support/pulsation; expected /scene/support/amplitude"));
  CHECK(holds(said("phase", {{"phase", 1.5}}), "another section, strobe at phase 1.5; expected strobe at phase 0"));
  study["beneath"] = (folder / "nowhere").string();
  CHECK(holds(error_of(study), "/beneath: "));
}

TEST_CASE("cases are computed again without the points beneath them") {
  StudyResults results;
  results.study = opened_continuation(tube_continuation()).study.resolved;
  results.study["beneath"] = "nowhere";
  CHECK(StoredStudy(results, {}).study.cases.size() == 1);
}

#pragma once
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <functional>

#include "runners/store/atomic_file.hpp"
#include "runners/store/read_store.hpp"
#include "tests/places.hpp"
#include "tests/runners/scratch_folder.hpp"
#include "tests/runners/variable.hpp"
#include "tests/runners/workers/quick_studies.hpp"

/// \file
/// A study that is under way for as long as a test wants, however fast the machine is.
namespace lingering {

/// The sweep of quick_studies::longer() with a law that takes its time while a `Held` lives: minutes, then. No
/// processor is busy meanwhile.
inline quick_studies::Json study() {
  quick_studies::Json study = quick_studies::longer();
  study["methods"]["mass"] = "consistent";
  study["methods"]["contact"] = {{"name", "stumbles"}, {"how", "linger"}, {"beyond", 0}};
  study["exponents"] = 0;
  study["refine"] = nullptr;
  return study;
}

inline const std::string plugin = " --plugin '" + ricochet::tests::places().stumbling + "'";

/// Processes that are started while it lives linger until it is let go.
class Held {
 public:
  Held() { write_text(file(), ""); }
  void let_go() const { std::filesystem::remove(file()); }

 private:
  std::filesystem::path file() const { return folder_ / "held"; }
  const ScratchFolder folder_;
  const Variable told_{"RICOCHET_TEST_HELD", file().string()};
};

/// Waits for what other processes make true; false after ten minutes, which only hung ones need.
inline bool comes_true(const std::function<bool()>& condition) {
  constexpr int tries = 30000;
  for (int i = 0; i < tries; ++i, ::usleep(20000))
    if (condition()) return true;
  return false;
}

/// Whether the store of a run tells that a case is marched.
inline bool marches(const std::filesystem::path& folder) {
  try {
    const auto cases = ricochet::read_status(folder).under_way;
    return std::any_of(cases.begin(), cases.end(), [](const auto& one) { return one.stage == "run"; });
  } catch (const ricochet::StoreError&) {
    return false;  // not yet there
  }
}

}  // namespace lingering

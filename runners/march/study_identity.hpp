#pragma once
#include <filesystem>
#include <ricochet/contract/registry.hpp>
#include <string>
#include <vector>

#include "runners/store/fingerprint.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

/// Tells apart processors, and C libraries, that compute other last digits. It is a hash of values of <cmath> functions
/// and of all digits of a forced beam between stops. The beam is marched some hundred steps by band, modal and sparse
/// operators. Equal digests are no proof that all digits are equal; unequal ones say that they are not. Computed once
/// per process, in a few ms.
const std::string& arithmetic_digest();

/// What tells the cases of a study, and everything that their results depend on, from others. Each library is read and
/// hashed once.
class StudyIdentity {
 public:
  StudyIdentity(const Study& study, const Registry& registry)
      : study_(study), registry_(registry), fingerprints_(study.kind, program_hash()) {}

  /// The fingerprint of a case.
  std::string of(const StudyCase& study_case);
  /// Of all cases together: equal for processes that compute the same.
  std::string of_all();

 private:
  const Study& study_;
  const Registry& registry_;
  Fingerprints fingerprints_;
};

/// The libraries of a case's mass, contact and time plugins; "" for a method of the program itself. A plan has none:
/// the case holds it.
std::vector<std::filesystem::path> libraries_of(const StudyCase& study_case, const Registry& registry);

}  // namespace ricochet

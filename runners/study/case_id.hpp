#pragma once
#include <string>
#include <unordered_map>

#include "runners/study/study.hpp"

namespace ricochet {

/// Gives cases their ids: 10 hex digits of FNV-1a (64 bits, finalised) over the canonical text (keys sorted, numbers in
/// shortest form) of everything that determines the case: kind, axes, scene, duration, samples. The order of keys and
/// of cases has no part in it; two different cases whose digits coincide are told apart by hashing the later one again.
class CaseIds {
 public:
  std::string next(const StudyCase& study_case, const std::string& kind);

 private:
  std::unordered_map<std::string, std::string> canonical_;  // id → text
};

}  // namespace ricochet

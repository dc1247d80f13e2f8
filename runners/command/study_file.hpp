#pragma once
#include <functional>

#include "runners/command/subcommand.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

/// A study with the plugins that it opened.
struct OpenStudy {
  Study study;
  Catalogue catalogue;
  Registry registry;
};

/// Loads the study that the first operand names and hands it over. An InputError, from loading or from `use`, is thrown
/// again as a StudyError that names file, line and pointer.
int with_study(const Arguments& arguments, const std::function<int(const OpenStudy&)>& use);

}  // namespace ricochet

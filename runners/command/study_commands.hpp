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

/// What a reader should know of the plugins before the study runs: methods of the study that a later library provides
/// too ("time 'newmark' of FILE is shadowed by FILE"), and plugin folders that are none. One sentence each.
std::vector<std::string> plugin_warnings(const OpenStudy& open);

}  // namespace ricochet

#pragma once
#include <cstdio>
#include <filesystem>
#include <set>
#include <string>

#include "runners/run/outputs.hpp"
#include "runners/store/store.hpp"

/// \file
/// How a folder whose cases are all in its store becomes one of results.
namespace ricochet {

/// Makes the views of the store and writes the tables, curves and report of what it holds, which is returned.
/// `changed`: see write_outputs().
StudyResults write_folder(Store& store, const std::filesystem::path& folder, const RenderReport& render,
                          const std::set<std::string>* changed = nullptr);

/// Says the answer, the totals (`how` they came about) and where the report is; returns the exit code.
int tell_results(std::FILE* out, const StudyResults& results, const std::filesystem::path& folder,
                 const std::string& how, bool table = false);

}  // namespace ricochet

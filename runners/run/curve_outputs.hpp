#pragma once
#include <filesystem>
#include <set>
#include <string>

#include "runners/store/record.hpp"

/// \file
/// The curves of a study as files: one for each case, or one for all.
namespace ricochet {

/// Writes curves/ID.csv of these cases into `folder`, where each has its file (has_curve_files), and removes those of
/// cases that have none. `changed`: the cases whose file must be written again; null means all. Throws StoreError.
void write_curve_files(const std::filesystem::path& folder, const StudyResults& results,
                       const std::set<std::string>* changed);

/// `curves` without rows, with the columns that any of these cases has.
Table curves_head(const StudyResults& results);

/// curves.csv in `folder`: `case`, then the columns of `curves`, one curve below the other, in the study's order.
/// Returns the table without rows. Throws StoreError.
Table write_curve_table(const std::filesystem::path& folder, const StudyResults& results);

/// Takes away what either of these wrote.
void remove_curve_files(const std::filesystem::path& folder);
void remove_curve_table(const std::filesystem::path& folder);

/// Removes the files of `folder` that are named like a case (ten hexadecimal digits) and are not of these.
void remove_stale(const std::filesystem::path& folder, const char* extension, const std::set<std::string>& wanted);

}  // namespace ricochet

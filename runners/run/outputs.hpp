#pragma once
#include <filesystem>
#include <functional>
#include <set>
#include <string>

#include "runners/store/record.hpp"

namespace ricochet {

/// Writes into `folder`, from the results alone: study.json, cases.csv, the derived tables, the exported tables of
/// numbers, curves/ID.csv, failures/ID.json, report.html (what `page` gives). Writes dictionary.csv, too: what every
/// column of these means. Each file is written whole or not at all. The curves of cases that are no longer in the study
/// are removed. `changed`: the cases whose curve must be written again; nothing means all. Throws StoreError.
void write_outputs(const std::filesystem::path& folder, const StudyResults& results,
                   const std::function<std::string()>& page, const std::set<std::string>* changed = nullptr);

/// Writes study.json and the tables as CSV: cases, the derived ones, those of numbers, curves/ID, measures (what each
/// means), left_out, notes, environment, dictionary. `one_file`: all curves in one curves.csv in place of curves/ID.
/// Throws StoreError, also for a folder with tables of another study.
void write_tables(const std::filesystem::path& folder, const StudyResults& results, bool one_file = false);

// The curves of a study as files: one for each case, or one for all.

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

/// Removes the files of `folder` that are named like a case (c and ten hexadecimal digits, or these alone) and are not
/// of these.
void remove_stale(const std::filesystem::path& folder, const char* extension, const std::set<std::string>& wanted);

}  // namespace ricochet

#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "runners/store/record.hpp"

/// \file
/// A result in one file (runners/packed-results.md): results, the study with the files that it read, and what computed
/// them, each part with its SHA-256.
namespace ricochet {

namespace packed {
inline constexpr const char* crate = "ro-crate-metadata.json";
inline constexpr const char* sums = "manifest-sha256.txt";
inline constexpr const char* answer = "answer.md";
inline constexpr const char* results = "results";  ///< the folder of results as a run left it
inline constexpr const char* study = "study";      ///< study.json, and beside it the files that it names
}  // namespace packed

/// Writes the results in `folder`, read as `results`, to `file`; returns the number of parts. The same folder makes the
/// same bytes. `answer`: questions and answers in Markdown. `packer`: what made tables and answer of the store, where
/// that is to be kept. Throws InputError where the study reads files outside of its folder, or one that has changed
/// since; StoreError (path and cause).
std::size_t pack_results(const std::filesystem::path& folder, const StudyResults& results, const std::string& answer,
                         const std::filesystem::path& file, const Environment& packer = {});

/// Writes the parts of `file` into the empty folder `place` and compares their sums; returns their names. Throws
/// InputError with the cause where the file is no packed result, is not whole, or is not as it was packed. What was
/// written by then stays: `place` is the caller's to remove.
std::vector<std::string> unpack_results(const std::filesystem::path& file, const std::filesystem::path& place);

/// The first part of the result unpacked in `place`, with the parts `names`, that is not what `packer` makes of its
/// store, `results`: the study, a file beside it, the description; "" where each is. `packer` is this program.
std::string other_than_described(const std::filesystem::path& place, const std::vector<std::string>& names,
                                 const StudyResults& results, const Environment& packer);

/// Whether the packed study says what its store says, in whatever writing.
bool same_study(const std::filesystem::path& place, const StudyResults& results);

/// What made tables and answer of the result that is unpacked in `place`. No entries where it does not say.
Environment packer_of(const std::filesystem::path& place);

}  // namespace ricochet

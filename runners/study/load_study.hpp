#pragma once
#include <filesystem>
#include <ricochet/loader/catalogue.hpp>
#include <string>

#include "runners/study/study.hpp"

namespace ricochet {

/// A study as it is written: in a file, on standard input ("-"), or in a pipe that a shell opened (`<(…)`), which gives
/// its text once. Files that a study without a folder names are looked for in the working folder.
struct StudyText {
  std::string place;  ///< as errors name it
  std::filesystem::path folder;
  std::string text;

  /// Throws InputError, pointer "".
  StudyText(const std::filesystem::path& name);  // NOLINT(google-explicit-constructor): a file stands for its text
  static std::string place_of(const std::filesystem::path& name);
  static bool is_file(const std::filesystem::path& name);
};

/// Checks and expands a study; opens only the plugins that it names. Nothing runs.
/// Throws InputError (pointer "" for the whole file) for everything a user can get wrong, PluginError for a plugin that
/// is there but does not serve.
Study load_study(const StudyText& study, Catalogue& catalogue, Registry& registry);

/// The same from text already read; files that it names are relative to `folder`.
Study parse_study(const std::string& text, Catalogue& catalogue, Registry& registry,
                  const std::filesystem::path& folder = {});

/// The error as a person reads it: "FILE:LINE: at /json/pointer: what is wrong; what was expected".
std::string explain(const InputError& error, const StudyText& study);

/// The JSON Schema (draft-07) of a study: every object closed, each key with its meaning, unit, range and default. It
/// has the parameters of every method that `registry` holds. What a schema cannot say (formulas, stops that cross,
/// excludes that match nothing) is left to load_study().
Json study_schema(const Registry& registry);

}  // namespace ricochet

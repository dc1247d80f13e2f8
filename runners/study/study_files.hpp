#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <ricochet/scene/scene.hpp>
#include <string>
#include <vector>

#include "runners/json/json_text.hpp"

namespace ricochet {

/// What is said of a file that is no longer what it was: a run ends by it.
inline constexpr const char* changed_since = "has changed since the run began";

/// The files that the scenes of a study name, each read once. Names are relative to the study's folder and stay in it,
/// unless the study says that they may lie outside.
/// Safe for several threads.
class StudyFiles {
 public:
  /// `known`: the key "files" of a study that was opened before, {"folder", "digests"}, or null. Its folder is then the
  /// one, and a file whose digest differs is an InputError.
  /// `outside`: files may lie outside the folder.
  StudyFiles(std::filesystem::path folder, const Json& known, bool outside = false);

  /// The structure of a checked scene of type assembled. Throws InputError below /scene/structure.
  std::shared_ptr<const AssembledStructure> assembled(const Json& structure);
  /// The structure of a description in modes, made once; the damping of its elastic modes into `ratios`.
  std::shared_ptr<const AssembledStructure> modal(const Json& structure, std::vector<double>& ratios);
  /// Two columns of a CSV file that a checked history names: {"file", "time", "value"}. Throws InputError below
  /// `pointer`.
  TimeTable table(const Json& history, const std::string& pointer);
  /// Those that a checked spectrum names: {"file", "frequency", "value"}, f (Hz) in the place of instants.
  TimeTable spectrum(const Json& given, const std::string& pointer);
  /// How the dofs of such a structure begin: the file of a checked initial state, which stands at `pointer`.
  std::vector<DofState> initial(const Json& initial, const Json& structure, const std::string& pointer);
  /// Adds to a scene the digests of the files that it names: they determine its results.
  void add_digests(Json& scene) const;
  /// What was recognised in the files that a scene names, each once.
  std::vector<std::string> notes(const Json& scene) const;
  /// What a stored study keeps: the folder, and the digest of each file by its name; null where no file was read.
  Json said() const;

 private:
  struct File {
    std::string content, digest;
    std::vector<std::string> notes;
  };
  /// The file of this name, read; `pointer` names it in the study.
  const File& file(const std::string& name, const std::string& pointer);
  TimeTable columns(const Json& history, bool spectrum, const std::string& pointer);
  /// Keeps what was recognised in it.
  void note(const std::string& name, const std::vector<std::string>& notes);

  std::filesystem::path folder_;
  Json known_;
  bool outside_;
  mutable std::mutex mutex_;
  std::map<std::string, File> files_;  ///< content is dropped once it has been understood
  std::map<std::string, std::shared_ptr<const AssembledStructure>> structures_;
  std::map<std::string, std::vector<double>> ratios_;  // of those in modes
  std::map<std::string, TimeTable> tables_;
};

}  // namespace ricochet

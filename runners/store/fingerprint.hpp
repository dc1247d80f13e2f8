#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "runners/store/record.hpp"
#include "runners/study/study.hpp"
#include "runners/table/text.hpp"

namespace ricochet {

/// A method with its parameters, as it is hashed.
Json content_of(const MethodChoice& method);

/// content_hash() of a file's bytes. Throws StoreError (path and cause) when it cannot be read.
std::string file_hash(const std::filesystem::path& file);

/// The program that computes: this one, or `ricochet` beside ricochet-mpi, which starts it.
std::filesystem::path program_file();

/// Hash of the running program: what the linker named the executable and the core library it uses, or their bytes where
/// it named none. Computed once per process.
const std::string& program_hash();

/// Decides whether a stored case is still the case of the study.
///
///     fingerprint = hash(case id, kind, resolved content of the case, bytes of each plugin library it uses, program)
///
/// Any change of these makes the case run again; nothing else does.
class Fingerprints {
 public:
  Fingerprints(std::string kind, std::string program) : kind_(std::move(kind)), program_(std::move(program)) {}
  /// `libraries`: files of the case's mass, contact and time plugins; "" for a method of the program itself.
  std::string of(const StudyCase& study_case, const std::vector<std::filesystem::path>& libraries);

 private:
  std::string kind_, program_;
  std::map<std::filesystem::path, std::string> files_;
};

/// The entry of this name; "" where there is none.
std::string environment_entry(const Environment& environment, const std::string& name);

/// The value of an entry without the place of a library: the hash of "…/libricochet-x.so (hash)". The same library is
/// the same wherever it lies.
std::string without_place(const std::string& name, const std::string& value);

/// The entry of an environment that is the digest of the processor's arithmetic (runners/march/study_identity.hpp).
inline constexpr const char* kArithmetic = "arithmetic";

/// Puts in the environment what arithmetic the finished cases were computed with: the digest, or all of them with their
/// numbers of cases. It replaces what runs have said of themselves. Nothing where no case says.
void tell_arithmetics(StudyResults& results);

/// Under which key motions of runs of one arithmetic are stored: those of another are not found.
std::string motion_key(const std::string& arithmetic, const std::string& key);

/// The environment of a resumed run: `now`, plus one entry "NAME (earlier cases)" for each value that was another when
/// the kept cases ran.
Environment merge_environments(const Environment& now, const Environment& earlier);

}  // namespace ricochet

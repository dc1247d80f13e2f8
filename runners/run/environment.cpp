#include "runners/run/environment.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <Spectra/Util/Version.h>
#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <muParserDef.h>
#include <sqlite3.h>
#include <sys/utsname.h>

#include <Eigen/Core>
#include <boost/version.hpp>
#include <cereal/version.hpp>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <ricochet/contract/abi.hpp>
#include <ricochet/kernels/instruction_set.hpp>
#include <ricochet/kernels/lane_kernels.hpp>
#include <string>
#if __has_include(<suitesparse/cholmod.h>)
#include <suitesparse/cholmod.h>
#endif

#include "runners/march/study_identity.hpp"
#include "runners/run/build_facts.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/store/folder_lock.hpp"
#include "runners/workers/allowed_processors.hpp"

namespace ricochet {
namespace {

std::string compiler() {
#if defined(__clang__)
  return "clang " __clang_version__;
#else
  return "g++ " __VERSION__;
#endif
}

std::string processor() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);)
    if (line.starts_with("model name")) {
      const std::size_t at = line.find(": ");
      if (at != std::string::npos) return line.substr(at + 2);
    }
  return "unknown";
}

std::string instruction_sets() {
#if defined(__x86_64__)
  std::vector<std::string> sets;
  if (__builtin_cpu_supports("sse4.2")) sets.emplace_back("sse4.2");
  if (__builtin_cpu_supports("avx")) sets.emplace_back("avx");
  if (__builtin_cpu_supports("avx2")) sets.emplace_back("avx2");
  if (__builtin_cpu_supports("fma")) sets.emplace_back("fma");
  if (__builtin_cpu_supports("avx512f")) sets.emplace_back("avx512f");
  return fmt::format("{}", fmt::join(sets, " "));
#else
  return "unknown";
#endif
}

// What marching does at once: doubles in a vector of the kernels, motions in a block.
std::string lanes() {
  const InstructionSet set = best_instruction_set();
  const int doubles = set == InstructionSet::avx512 ? 8 : set == InstructionSet::avx2 ? 4 : 2;
  constexpr int most = 32;
  return fmt::format("{} doubles at once ({}), 1 to {} lanes in a block", doubles, lane_instruction_set(),
                     lane_width(most));
}

std::string kernel() {
  utsname name{};
  return ::uname(&name) == 0 ? fmt::format("{} {} {}", name.sysname, name.release, name.machine) : "unknown";
}

std::string libraries() {
  std::vector<std::string> names = {
      fmt::format("Eigen {}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION),
      fmt::format("Boost {}.{}.{}", BOOST_VERSION / 100000, BOOST_VERSION / 100 % 1000, BOOST_VERSION % 100),
      fmt::format("fmt {}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100),
      fmt::format("nlohmann-json {}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                  NLOHMANN_JSON_VERSION_PATCH),
      fmt::format("SQLite {}", sqlite3_libversion()),
      fmt::format("SQLiteCpp {}", SQLITECPP_VERSION),
      fmt::format("muParser {}", mu::ParserVersion),
      fmt::format("Spectra {}.{}.{}", SPECTRA_MAJOR_VERSION, SPECTRA_MINOR_VERSION, SPECTRA_PATCH_VERSION),
      fmt::format("cereal {}.{}.{}", CEREAL_VERSION_MAJOR, CEREAL_VERSION_MINOR, CEREAL_VERSION_PATCH),
      fmt::format("glibc {}", ::gnu_get_libc_version()),
#ifdef CHOLMOD_MAIN_VERSION
      fmt::format("CHOLMOD {}.{}.{}", CHOLMOD_MAIN_VERSION, CHOLMOD_SUB_VERSION, CHOLMOD_SUBSUB_VERSION),
#endif
  };
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

Environment describe_environment(const std::vector<std::filesystem::path>& plugin_libraries) {
  const BuildFacts build = build_facts();
  Environment environment;
  environment.entries = {
      {"program", "ricochet " + build.version},
      {"commit", build.commit},
      {"compiler", compiler()},
      {"contract", abi_tag()},
      {"build type", build.type},
      {"flags", build.flags},
      {"processor", processor()},
      {"cores", allowed_processors().text()},
      {"instruction sets", instruction_sets()},
      {"lanes", lanes()},
      {kArithmetic, arithmetic_digest()},
      {"kernel", kernel()},
      {"libraries", libraries()},
  };
  for (const auto& library : plugin_libraries) {
    constexpr std::size_t digits = 12;
    environment.entries.emplace_back("plugin " + library.filename().string(),
                                     fmt::format("{} ({})", library.string(), file_hash(library).substr(0, digits)));
  }
  environment.entries.emplace_back(kStarted, utc_time());
  return environment;
}

}  // namespace ricochet

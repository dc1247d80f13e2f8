// What a worker process finds in its environment.
#include "runners/workers/worker_process.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/runners/variable.hpp"

using namespace ricochet;

namespace {

int count(const std::string& head) {
  const auto all = worker_environment();
  return static_cast<int>(
      std::count_if(all.begin(), all.end(), [&](const auto& one) { return one.starts_with(head); }));
}

}  // namespace

TEST_CASE("a worker has one thread for its BLAS where nothing else is said, and nothing of a launcher") {
  const Variable rank("OMPI_COMM_WORLD_RANK", "3"), own("RICOCHET_PLUGIN_PATH", "/somewhere");
  CHECK(count("OMPI_") == 0);
  CHECK(count("RICOCHET_PLUGIN_PATH=/somewhere") == 1);
  {
    const Variable unsaid("OPENBLAS_NUM_THREADS", {});
    CHECK(count("OPENBLAS_NUM_THREADS=1") == 1);
  }
  const Variable said("OPENBLAS_NUM_THREADS", "4");
  CHECK(count("OPENBLAS_NUM_THREADS=4") == 1);
  CHECK(count("OPENBLAS_NUM_THREADS=") == 1);
}

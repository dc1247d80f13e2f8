// Whatever bytes a file has, it is read or told. RICOCHET_FUZZ sets the number of files.
#include <cstdlib>
#include <random>
#include <ricochet/scene/files/text_file.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>

#include "tests/scene/structure/beam_files.hpp"
#include "tests/scene/working_set.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace changed_bytes_tests {
namespace {

/// One to three changes: a byte, a piece cut out, bytes put in, the end cut off.
void change(std::string& text, std::mt19937& random) {
  static const std::string bytes = "0123456789 .,;-+eEdD%#*[]()\n\r\t\"naif\xEF\xFF" + std::string(1, '\0');
  for (std::uint32_t k = 0, count = 1 + random() % 3; k < count && !text.empty(); ++k) {
    const std::size_t at = random() % text.size();
    switch (random() % 4) {
      case 0:
        text[at] = bytes[random() % bytes.size()];
        break;
      case 1:
        text.erase(at, 1 + random() % 9);
        break;
      case 2:
        text.insert(at, 1 + random() % 4, bytes[random() % bytes.size()]);
        break;
      default:
        text.resize(at + 1);
    }
  }
}

/// Of so many changed files, how many can still be read. What else is thrown, or touched, ends the test.
template <class Read>
long readable(const std::string& file, long count, std::mt19937& random, Read read) {
  long found = 0;
  std::string text;
  for (long k = 0; k < count; ++k) {
    text = file;
    change(text, random);
    try {
      read(text);
      ++found;
    } catch (const FileError&) {
    }
  }
  return found;
}

}  // namespace

TEST_CASE("whatever bytes a file has, it is read or told") {
  constexpr long files = 1000000;
  const char* asked = std::getenv("RICOCHET_FUZZ");
  const long each = (asked ? std::atol(asked) : files) / 10;
  std::mt19937 random(20261126);
  const BeamFiles beam = beam_files(beam_of(*std::make_unique<SceneSpec>(unit_beam())), 1);
  const std::string array = "%%MatrixMarket matrix array real general\n3 3\n4\n-1\n0\n-1\n4\n-1.5\n0\n-1.5e0\n4\n";
  const auto matrix = [](int dofs) {
    return [dofs](const std::string& text) { read_matrix_market(text, "K.mtx", dofs, "dofs.csv"); };
  };
  const CsvFile modes = read_csv("mode,frequency,mass,damping\n1,5,2,0.01\n2,3,1,0.02\n", "modes.csv"),
                shapes = read_csv("point,1,2\na,1,0.5\nb,-1,2\n", "shapes.csv");
  // Few of them: each finds eigenvalues.
  constexpr long slower = 10;
  const auto modal = [](const CsvFile& list, const CsvFile& rows, const CsvFile& residual) {
    std::vector<double> ratios;
    const AssembledStructure made = modal_structure({list, rows, residual, {}, {}}, ratios);
    for (const SparseMatrix* matrix : {&made.stiffness, &made.mass})
      if (!Eigen::MatrixXd(*matrix).allFinite()) throw std::runtime_error("a matrix that is not finite");
  };
  const std::string flexible = "point,a,b\na,4e-7,1e-7\nb,1e-7,3e-7\n";
  const CsvFile residual = read_csv(flexible, "residual.csv");
  CHECK(readable("mode,frequency,mass,damping\n1,5,2,0.01\n2,3,1,0.02\n", each / slower, random,
                 [&](const std::string& text) { modal(read_csv(text, "modes.csv"), shapes, residual); }) > 0);
  CHECK(readable("point,1,2\na,1,0.5\nb,-1,2\n", each / slower, random,
                 [&](const std::string& text) { modal(modes, read_csv(text, "shapes.csv"), residual); }) > 0);
  CHECK(readable(flexible, each / slower, random,
                 [&](const std::string& text) { modal(modes, shapes, read_csv(text, "residual.csv")); }) > 0);
  const auto table = [](const std::string& text) { read_csv(text, "a.csv"); };
  std::string utf16 = "\xFF\xFE";
  for (const char c : std::string("t,a\n0,1\n1,2\n")) (utf16 += c) += '\0';
  for (const long found :
       {readable(beam.stiffness, each, random, matrix(4)), readable(array, each, random, matrix(3)),
        readable(beam.dofs, each, random, [](const std::string& text) { read_dof_table(text, "dofs.csv"); }),
        readable("t,a\n0,0\n0.025,9.81\n0.05,0\n", each, random, table),
        readable("# by hand\nt [s];a (m/s2)\n0,0;-1,5D0\n0,025;9,81\n", each, random, table),
        readable("# t a\n0.0 -1.5+000\n  0.1 2\n", each, random, table),
        readable("\"t\",\"a\"\n\"0\",1\n", each, random, table), readable(utf16, each, random, table),
        readable("%%MatrixMarket matrix coordinate real symmetric\n3 3 4\n% comment\n1 1 2.0D+00\n1 2 -1\n2 2 2\n"
                 "1 1 1.0+000\n",
                 each, random, matrix(3)),
        readable("RECORD\nVALLEY\nUNITS OF G\nNPTS= 7, DT= .01 SEC\n 1 2 3 4 5\n 6 -.7E+00\n", each, random,
                 [](const std::string& text) { read_at2(text, "a.AT2"); })}) {
    CHECK(found > 0);
    CHECK(found < each);
  }
}

}  // namespace changed_bytes_tests

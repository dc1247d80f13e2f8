// What files of matrices and tables give, and what each fault of them says.
#include <ricochet/scene/files/text_file.hpp>

#include "tests/runners/scratch_folder.hpp"
#include "tests/scene/structure/beam_files.hpp"
#include "tests/scene/working_set.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

template <class Read>
std::string fault(Read read) {
  try {
    read();
  } catch (const FileError& error) {
    return error.what();
  }
  return "no error";
}

FileMatrix matrix(const std::string& text, int dofs) {
  return read_matrix_market(text, "K.mtx", dofs, "dofs.csv");
}
std::string matrix_fault(const std::string& text, int dofs) {
  return fault([&] { matrix(text, dofs); });
}

const std::string header = "%%MatrixMarket matrix coordinate real symmetric\n";
const std::string table_header = "dof,node,component,x,y,z,held\n";

}  // namespace

TEST_CASE("the four forms of a Matrix Market file give one matrix") {
  Eigen::Matrix3d expected;
  expected << 4, -1, 0, -1, 4, -1.5, 0, -1.5, 4;
  for (const std::string& text : std::vector<std::string>{
           header + "% remark\n3 3 5\n1 1 4\n2 1 -1\n2 2 4\n3 2 -1.5\n3 3 4\n",
           ("%%matrixmarket MATRIX Coordinate Real General\n3 3 7\n1 1 4\n1 2 -1\n2 1 -1\n2 2 4\n2 3 -1.5\n"
            "3 2 -1.5\n3 3 4\n"),
           ("%%MatrixMarket matrix array real symmetric\n3 3\n4\n-1\n0\n4\n-1.5\n4\n"),
           ("\xEF\xBB\xBF%%MatrixMarket matrix array real general\r\n3 3\r\n4\r\n-1\r\n0\r\n-1\r\n+4\r\n"
            "-1.5\r\n0\r\n-1.5e0\r\n4"),
       })
    CHECK(Eigen::Matrix3d(matrix(text, 3).matrix) == expected);
}

TEST_CASE("a general matrix is the mean of its triangles, and says how far they are apart") {
  const FileMatrix read =
      matrix("%%MatrixMarket matrix coordinate real general\n2 2 4\n1 1 1\n1 2 0.5\n2 1 0.25\n2 2 2\n", 2);
  CHECK(read.matrix.coeff(0, 1) == 0.375);
  CHECK(read.matrix.coeff(1, 0) == 0.375);
  CHECK(read.asymmetry == 0.125);
  CHECK((read.row == 2 && read.column == 1 && read.there == 0.25 && read.across == 0.5));
}

TEST_CASE("a fault of a Matrix Market file has file, line, what was found and what was expected") {
  CHECK(matrix_fault("", 2) ==
        "K.mtx is empty; expected %%MatrixMarket matrix, coordinate or array, real or integer, symmetric or general");
  CHECK(
      matrix_fault("%%MatrixMarket matrix coordinate complex general\n", 2) ==
      "K.mtx, line 1: \"%%MatrixMarket matrix coordinate complex general\"; expected %%MatrixMarket matrix, coordinate "
      "or array, real or integer, symmetric or general");
  CHECK(matrix_fault("%MatrixMarket matrix coordinate real general\n2 2 0\n", 2) ==
        "K.mtx, line 1: \"%MatrixMarket matrix coordinate real general\"; expected %%MatrixMarket matrix, coordinate "
        "or array, real or integer, symmetric or general");
  CHECK(matrix_fault(header + "2 2\n", 2) == "K.mtx, line 2: \"2 2\"; expected rows, columns and number of entries");
  CHECK(matrix_fault(header + "3 3 1\n1 1 1\n", 2) == "K.mtx is 3 × 3; expected 2 × 2, the dofs of dofs.csv");
  CHECK(matrix_fault(header + "2 2 2\n1 1 1\n", 2) == "K.mtx, line 3: end of file after 1 of 2 entries");
  CHECK(matrix_fault(header + "2 2 1\n3 1 1\n", 2) == "K.mtx, line 3: row 3 of a matrix of 2");
  CHECK(matrix_fault(header + "2 2 1\n0 1 1\n", 2) == "K.mtx, line 3: row 0 of a matrix of 2");
  CHECK(matrix_fault(header + "2 2 3\n1 1 1\n1 2 1\n2 1 1\n", 2) ==
        "K.mtx, line 5: entries 2, 1 and 1, 2 both stand in a symmetric file; expected one of the triangles, or "
        "general in its first line");
  CHECK(matrix_fault(header + "2 2 2\n1 1 1e308\n1 1 1e308\n", 2) ==
        "K.mtx, line 3: the sum of entries 1, 1 is not finite");
  CHECK(matrix_fault(header + "2 2 1\n1 1 1,5\n", 2) == "K.mtx, line 3: \"1,5\" has a decimal comma; expected a point");
  CHECK(matrix_fault(header + "2 2 1\n1 1 ****\n", 2) ==
        "K.mtx, line 3: \"****\" is a number too long for its field in Fortran; expected a finite number");
  for (const std::string word : {"nan", "inf", "1e999", "1+5", "1d", "1.0D+", "0x1p3"})
    CHECK(matrix_fault(header + "2 2 1\n1 1 " + word + "\n", 2) ==
          "K.mtx, line 3: \"" + word + "\"; expected a finite number");
  CHECK(matrix_fault(header + "2 2 1\n1 1 1\n2 2 1\n", 2) == "K.mtx, line 4: \"2 2 1\" after the last of 1 entries");
  // Counts are checked before memory is taken.
  CHECK(matrix_fault(header + "2 2 9000000000000\n1 1 1\n", 2) ==
        "K.mtx, line 2: 9000000000000 entries in the 6 bytes that follow");
  CHECK(matrix_fault(header + std::string(70000, ' ') + "\n", 2) ==
        "K.mtx, line 2: 70000 bytes long; expected at most 65536");
}

TEST_CASE("a table of dofs is told by its header, in any order of columns and rows") {
  const DofTable table =
      read_dof_table("held,dof,component,node,z,y,x\r\n\r\nwall, 2 ,rz,N1,0,0,1.5\r\n,1,uy,N1,0,0,1.5", "dofs.csv");
  REQUIRE(table.dofs.size() == 2);
  CHECK(table.dofs[0].text() == "N1 uy");
  CHECK(table.dofs[0].held.empty());
  CHECK(table.dofs[1].held == "wall");
  CHECK(table.dofs[1].rotation());
  CHECK(table.dofs[1].place == std::array<double, 3>{1.5, 0, 0});
}

TEST_CASE("a fault of a table of dofs has file, line, what was found and what was expected") {
  const auto table_fault = [](const std::string& text) { return fault([&] { read_dof_table(text, "dofs.csv"); }); };
  CHECK(table_fault("") == "dofs.csv is empty; expected a header of columns");
  CHECK(table_fault(table_header) == "dofs.csv has no dofs; expected one row per row of the matrices");
  CHECK(table_fault("dof,node,comp,x,y,z,held\n") ==
        "dofs.csv has no column \"component\"; there are dof,node,comp,x,y,z,held: did you mean comp?");
  CHECK(table_fault("dof,node,dof\n") == "dofs.csv, line 1: column \"dof\" stands a second time");
  CHECK(table_fault(table_header + "1,N1,uy,0,0,0\n") == "dofs.csv, line 2: 6 cells; expected 7, as in the header");
  CHECK(table_fault(table_header + "1,N1,uy,0,0,0,\n1,N2,uy,0,0,0,\n") ==
        "dofs.csv, line 3: dof 1 stands a second time");
  CHECK(table_fault(table_header + "1,N1,uy,0,0,0,\n3,N2,uy,0,0,0,\n") ==
        "dofs.csv, line 3: dof 3 of a table of 2; expected 1 to 2, each once: 2 is missing");
  CHECK(table_fault(table_header + "1,N1,uy,0,0,0,\n2,N1,uy,0,0,0,\n") == "dofs.csv, line 3: N1 uy is dof 1 and dof 2");
  CHECK(table_fault(table_header + "1,N1,uy,0,0,0,\n2,N1,rz,1,0,0,\n") ==
        "dofs.csv, line 3: node N1 has two places; expected the same x, y, z in its rows");
  CHECK(table_fault(table_header + "one,N1,uy,0,0,0,\n") ==
        "dofs.csv, line 2: \"one\" for dof; expected a whole number from 1");
  CHECK(table_fault(table_header + "1,,uy,0,0,0,\n") ==
        "dofs.csv, line 2: \"\" for node; expected a word without spaces");
  CHECK(table_fault(table_header + "1,N1,uy,0,0,0,1\n2,N2,uy,0,0,0,0\n") ==
        "dofs.csv, line 3: \"0\" for held; expected nothing where it is free, fixed or the name of a support");
  CHECK(table_fault(table_header + "1,N1,uy,0,nan,0,\n") ==
        "dofs.csv, line 2: \"nan\" for y; expected a finite number");
  CHECK(table_fault(table_header + "1,\"N1\",uy,0,0,0,\n") == "no error");
}

TEST_CASE("a file that is missing has the names that are there, and one that is too large its limit") {
  const ScratchFolder folder;
  write_text(folder / "Km.mtx", "x");
  write_text(folder / "M.mtx", "y");
  CHECK(fault([&] { read_file(folder.path(), "K.mtx"); }) ==
        "\"K.mtx\": no such file; there are Km.mtx, M.mtx; did you mean \"Km.mtx\"?");
  CHECK(read_file(folder.path(), "M.mtx") == "y");
  CHECK(fault([&] { read_file(folder.path(), "."); }) == "\".\" is no file; expected one that can be read");
  ::setenv("RICOCHET_FILE_LIMIT", "0", 1);
  CHECK(fault([&] { read_file(folder.path(), "M.mtx"); }).ends_with("the limit is 0 MiB (RICOCHET_FILE_LIMIT, bytes)"));
  for (const char* wrong : {"abc", "-5", "1e6"}) {
    ::setenv("RICOCHET_FILE_LIMIT", wrong, 1);
    CHECK(fault([&] { read_file(folder.path(), "M.mtx"); }) ==
          std::string("the environment has RICOCHET_FILE_LIMIT=\"") + wrong + "\"; expected a whole number of bytes");
  }
  ::setenv("RICOCHET_FILE_LIMIT", "", 1);
  CHECK(read_file(folder.path(), "M.mtx") == "y");
  ::unsetenv("RICOCHET_FILE_LIMIT");
}

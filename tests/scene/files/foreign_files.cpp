// Files as other programs write them: read where their meaning is certain, which a note says, else refused with the
// cause.
#include <ricochet/scene/files/text_file.hpp>

#include "tests/scene/structure/beam_files.hpp"
#include "tests/scene/working_set.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace foreign_files_tests {
namespace {

using Notes = std::vector<std::string>;

template <class Read>
std::string fault_of(Read read) {
  try {
    read();
  } catch (const FileError& error) {
    return error.what();
  }
  return "no error";
}

const std::string header = "%%MatrixMarket matrix coordinate real symmetric\n";

FileMatrix matrix(const std::string& text) {
  return read_matrix_market(text, "K.mtx", 2, "dofs.csv");
}

CsvFile table(const std::string& text) {
  return read_csv(text, "a.csv");
}

std::string table_fault(const std::string& text) {
  return fault_of([&] { table(text); });
}

/// The same text in UTF-16, the byte order mark before it.
std::string in_utf16(const std::string& text, bool little) {
  std::string out = little ? "\xFF\xFE" : "\xFE\xFF";
  for (const char c : text) {
    if (!little) out += '\0';
    out += c;
    if (little) out += '\0';
  }
  return out;
}

}  // namespace

TEST_CASE("a number of Fortran is the number that it is in C++") {
  for (const auto& [fortran, plain] : std::vector<std::pair<std::string, double>>{{"1.0D+06", 1e6},
                                                                                  {"-2.5d-3", -2.5e-3},
                                                                                  {"+.5D0", 0.5},
                                                                                  {"3D2", 300},
                                                                                  {"1.0+006", 1e6},
                                                                                  {"-1.25-010", -1.25e-10},
                                                                                  {"1.D0", 1}}) {
    CHECK(fortran_number(fortran) == plain);
    CHECK_FALSE(plain_number(fortran));
  }
  for (const char* other : {"1+6", "D6", "1D", "1D+", "1.0D+06x", "1.0E5", "..D1", "-D1", "1.0DD2", "1D999", ""})
    CHECK_FALSE(fortran_number(other));
}

TEST_CASE("a matrix means the same in whatever certain form it stands, and a note says which that was") {
  const Eigen::Matrix2d expected = (Eigen::Matrix2d() << 3, -1, -1, 2).finished();
  const std::vector<std::pair<std::string, Notes>> forms = {
      {header + "% usual\n2 2 3\n1 1 3\n2 1 -1\n2 2 2\n", {}},
      {header + "2 2 3\n% code_aster\n1 1 3\n# another\n2 1 -1\n2 2 2\n% end\n",
       {"K.mtx: comments among its entries are left out (lines: 3)"}},
      {"% written by hand\n" + header + "2 2 3\n1 1 3\n2 1 -1\n2 2 2\n", {}},
      {header + "2 2 3\n1 1 0.3D+01\n2 1 -1.0+000\n2 2 2\n",
       {"K.mtx: exponents of Fortran are read, as 0.3D+01 (entries: 2)"}},
      {header + "2 2 3\n1 1 3\n1 2 -1\n2 2 2\n",
       {"K.mtx: entries of a symmetric file above its diagonal stand for both triangles (entries: 1)"}},
      {header + "2 2 5\n1 1 1\n2 1 -1\n1 1 1\n2 2 2\n1 1 1\n",
       {"K.mtx: values of an entry that stands more than once are summed, as of 1, 1 (entries: 1)"}},
      {"%%MatrixMarket matrix coordinate integer general\n2 2 5\n1 1 3\n1 2 -2\n2 1 -1\n2 2 2\n1 2 1\n",
       {"K.mtx: values of an entry that stands more than once are summed, as of 1, 2 (entries: 1)"}}};
  for (const auto& [text, notes] : forms) {
    const FileMatrix read = matrix(text);
    CHECK(Eigen::Matrix2d(read.matrix) == expected);
    CHECK(read.asymmetry == 0);
    CHECK(read.notes == notes);
  }
  for (const bool little : {true, false}) {
    const FileMatrix read = matrix(in_utf16(forms[0].first, little));
    CHECK(Eigen::Matrix2d(read.matrix) == expected);
    CHECK(read.notes == Notes{"K.mtx is read as UTF-16"});
  }
}

TEST_CASE("a matrix that is gyroscopic is refused with that word") {
  CHECK(fault_of([] {
          matrix("%%MatrixMarket matrix coordinate real skew-symmetric\n2 2 1\n2 1 30\n");
        }).ends_with("gyroscopic and circulatory terms are not treated"));
  const std::string general =
                        "%%MatrixMarket matrix coordinate real general\n2 2 4\n1 1 4\n1 2 -1\n2 1 -1.00001\n2 2 4\n",
                    fine = header + "2 2 2\n1 1 4\n2 2 4\n";
  for (const std::string which : {"K", "M", "C"}) {
    AssembledFiles files;
    files.table = read_dof_table("dof,node,component,x,y,z,held\n1,A,uy,0,0,0,\n2,A,uz,0,0,0,\n", "dofs.csv");
    files.stiffness = matrix(which == "K" ? general : fine);
    files.mass = matrix(which == "M" ? general : fine);
    files.damping = matrix(which == "C" ? general : fine);
    files.stiffness_name = "K.mtx";
    files.mass_name = "M.mtx";
    files.damping_name = "C.mtx";
    CHECK(fault_of([&] { assemble_structure(files); }) ==
          which +
              ".mtx is not symmetric: entries 2, 1 and 1, 2 (A uz, A uy) are -1.00001 and -1. They differ by "
              "1e-05, 2.5e-06 of the largest entry; expected at most 1e-10; gyroscopic and circulatory terms are "
              "not treated");
  }
}

TEST_CASE("a pivot below zero is round-off down to 1e-12 of the largest") {
  const auto made = [](double mass, double stiffness) {
    AssembledFiles files;
    files.table = read_dof_table("dof,node,component,x,y,z,held\n1,A,ux,0,0,0,\n2,B,ux,0,0,0,\n", "dofs.csv");
    files.stiffness = matrix(header + "2 2 3\n1 1 4\n2 1 -1\n2 2 " + std::to_string(stiffness) + "\n");
    files.mass = matrix(header + fmt::format("2 2 2\n1 1 3\n2 2 {}\n", mass));
    files.stiffness_name = "K.mtx";
    files.mass_name = "M.mtx";
    return assemble_structure(files);
  };
  const AssembledStructure near = made(-2e-12, 4);
  CHECK(near.notes == Notes{"M.mtx has a negative pivot -2e-12 at dof 2 (B ux), -6.7e-13 of the largest: taken for 0"});
  CHECK(near.mass.coeff(0, 0) + near.mass.coeff(1, 1) == 3);
  CHECK(made(0, 4).notes.empty());
  CHECK(fault_of([&] { made(-4e-12, 4); }) ==
        "M.mtx has a negative pivot -4e-12 at dof 2 (B ux), beyond -1e-12 of the largest: a mass is positive "
        "semidefinite");
  CHECK(fault_of([&] { made(1, 0.2); }).starts_with("K.mtx has a negative pivot "));
}

TEST_CASE("a table means the same in whatever certain form it stands, and a note says which that was") {
  const std::vector<std::pair<std::string, Notes>> forms = {
      {"t,a\n0,-1.5\n0.5,2\n", {}},
      {"\xEF\xBB\xBFt,a\r\n0,-1.5\r\n0.5,2\r\n", {}},
      {"t,a\r0,-1.5\r0.5,2", {}},
      {"t,\ta\n0,\t-1.5\n0.5,\t2\n", {}},
      {"t,a\n0,-1.5D0\n0.5,2.0+000\n", {"a.csv: exponents of Fortran are read, as -1.5D0 (cells: 2)"}},
      {"\"t\",\"a\"\n\"0\",-1.5\n0.5,\"2\"\n", {"a.csv: its cells are in quotes"}},
      {"# station\n% of 1987\nt,a\n0,-1.5\n# pause\n0.5,2\n", {"a.csv: comments are left out (lines: 3)"}},
      {"# station\n# t,a\n0,-1.5\n0.5,2\n",
       {"a.csv: the header is the comment \"# t,a\"", "a.csv: comments are left out (lines: 1)"}},
      {"t;a\n0;-1.5\n0.5;2\n", {"a.csv: semicolons separate its cells"}},
      {"sep=;\nt;a\n0;-1,5\n0,5;2\n",
       {"a.csv: decimal commas are read as points", "a.csv: semicolons separate its cells"}},
      {"t\ta\n0\t-1,5\n0,5\t2\n", {"a.csv: decimal commas are read as points", "a.csv: tabs separate its cells"}},
      {"  t   a\n  0.0  -1.5\n  0.5   2\n", {"a.csv: blanks separate its cells"}},
      {"t [s] a (m/s2)\n0 -1.5\n0.5 2\n", {"a.csv: blanks separate its cells"}},
      {"t [s],a [m/s^2]\n0,-1.5\n0.5,2\n", {}}};
  for (const auto& [text, notes] : forms) {
    INFO(text);
    const CsvFile read = table(text);
    const std::size_t t = read.column("t"), a = read.column("a");
    REQUIRE(read.rows.size() == 2);
    CHECK(read.number(read.rows[0], t) == 0);
    CHECK(read.number(read.rows[1], t) == 0.5);
    CHECK(read.number(read.rows[0], a) == -1.5);
    CHECK(read.number(read.rows[1], a) == 2);
    CHECK(read.notes == notes);
  }
  CHECK(table(in_utf16("t,a\n0,1\n", true)).notes == Notes{"a.csv is read as UTF-16"});
  const CsvFile units = table("t [s],a (cm/s2),n\n0,1,2\n");
  CHECK((units.unit(0) == "s" && units.unit(1) == "cm/s2" && units.unit(2).empty()));
  CHECK(table("p,q\n\"a, \"\"b\"\"\",1\n").rows[0].cells[0] == "a, \"b\"");
}

TEST_CASE("a table whose meaning is not certain is refused with the cause") {
  CHECK(table_fault("t,a\n0,00,-1,5\n0,01,-1,0\n") ==
        "a.csv, line 2: 4 cells; expected 2, as in the header: these are decimal commas; expected points, or "
        "semicolons between cells");
  CHECK(table_fault("t;a\n0,5;1.5\n") ==
        "a.csv, line 2: decimal commas (line 2) and points (line 2) in one table; expected one of them");
  CHECK(table_fault("t;a\n1;1,234\n2;5,678\n") ==
        "a.csv, line 2: commas before three digits; expected a decimal point, and no thousands");
  CHECK(table_fault("t,a\n0;1\n").ends_with("semicolons separate cells here; expected what separates the header"));
  CHECK(table_fault("t,a\n0 1\n").ends_with("blanks separate cells here; expected what separates the header"));
  CHECK(table_fault("0,1\n0.5,2\n") == "a.csv, line 1: numbers alone; expected a header of names before them, as t,a");
  CHECK(table_fault("RECORD\nIMPERIAL VALLEY, 1979\nACCELERATION\n 1.0 2.0 3.0 4.0 5.0\n")
            .ends_with("of an AT2 table give both, as \"NPTS= 1559, DT= 0.02 SEC\""));
  CHECK(table_fault("t,a\n0,\"1\n") == "a.csv, line 2: a quote that is not closed in its line");
  CHECK(table_fault("t,a\n0,1\"2\n") == "a.csv, line 2: a quote within a cell; expected it round the whole cell");
  CHECK(table_fault(in_utf16("t,a\n0,1\n", true).substr(2)) ==
        "a.csv has zero bytes: it is UTF-16 without a byte order mark, or no text; expected UTF-8");
  CHECK(fault_of([] { table("t [s],t (s)\n0,1\n").column("t"); }) ==
        "a.csv has more than one column \"t\"; there are t [s],t (s)");
}

TEST_CASE("an accelerogram of AT2 has as many values as it says, dt apart") {
  const std::string text = "PEER RECORD\nVALLEY\nACCELERATION TIME SERIES IN UNITS OF G\n";
  const auto read = [](const std::string& content) { return read_at2(content, "a.AT2"); };
  for (const std::string line : {"NPTS=   7, DT= .0200 SEC", "NPTS= 7, DT= 2.0D-02 SEC,", "7  0.0200  NPTS, DT"}) {
    const auto found = read(text + line + "\n 1 2 3 4 5\r\n -.6E+01 7\n");
    REQUIRE(found);
    CHECK(found->step == 0.02);
    CHECK(found->values == std::vector<double>{1, 2, 3, 4, 5, -6, 7});
    CHECK(found->unit == "G");
    CHECK(found->notes == Notes{"a.AT2 is read as AT2: 7 values in G, dt 0.02 s, the first at t = 0"});
  }
  CHECK_FALSE(read("t,a\n0,1\n1,2\n"));
  CHECK_FALSE(read("NPTS,DT\n1,2\n"));
  CHECK(fault_of([&] { read(text + "NPTS= 7\n1 2\n"); }) ==
        "a.AT2, line 4: an AT2 table without dt; give it beside NPTS, as DT= 0.02 SEC");
  CHECK(fault_of([&] { read(text + "NPTS= x, DT= 0.1\n1 2\n"); }) ==
        "a.AT2, line 4: an AT2 table without its number of values; give it beside DT, as NPTS= 1559");
  CHECK(fault_of([&] { read(text + "NPTS= 3, DT= 0.1\n1 2\n"); }) ==
        "a.AT2, line 5: end of file after 2 values; NPTS says 3");
  CHECK(fault_of([&] { read(text + "NPTS= 2, DT= 0.1\n1 2\n3\n"); }) ==
        "a.AT2, line 6: a value after the 2 that NPTS says");
}

}  // namespace foreign_files_tests

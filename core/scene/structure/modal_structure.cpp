#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ricochet/contract/errors.hpp>
#include <ricochet/kernels/eigenvalues.hpp>
#include <ricochet/scene/files/text_file.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>

namespace ricochet {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Mode {
  int number = 0;  // in the file, from 1
  double frequency = 0, mass = 0, damping = 0;
  double stiffness() const {
    const double omega = 2 * std::numbers::pi * frequency;
    return mass * omega * omega;
  }
};

std::vector<Mode> read_modes(const CsvFile& table) {
  const std::size_t number = table.column("mode"), frequency = table.column("frequency"), mass = table.column("mass"),
                    damping = table.column("damping");
  const auto count = static_cast<long long>(table.rows.size());
  if (count == 0) throw FileError(table.name + " has no mode; expected one or more");
  std::vector<bool> met(table.rows.size(), false);
  std::vector<Mode> modes;
  for (const CsvFile::Row& row : table.rows) {
    const auto k = whole_number(row.cells[number]);
    if (!k || *k < 1 || *k > count)
      table.fail(row, fmt::format("mode \"{}\" of a table of {}; expected 1 to {}", shortened(row.cells[number]), count,
                                  count));
    if (met[static_cast<std::size_t>(*k) - 1]) table.fail(row, fmt::format("mode {} stands a second time", *k));
    met[static_cast<std::size_t>(*k) - 1] = true;
    const Mode one{static_cast<int>(*k), table.number(row, frequency), table.number(row, mass),
                   table.number(row, damping)};
    if (one.frequency < 0) table.fail(row, fmt::format("frequency {:g} Hz; expected 0 or above", one.frequency));
    if (!(one.mass > 0)) table.fail(row, fmt::format("mass {:g} kg; expected above 0", one.mass));
    if (!(std::abs(one.damping) < 1))
      table.fail(row, fmt::format("damping ratio {:g}; expected one between -1 and 1", one.damping));
    if (!std::isfinite(one.stiffness()))
      table.fail(
          row, fmt::format("frequency {:g} Hz and mass {:g} kg; expected a finite stiffness", one.frequency, one.mass));
    modes.push_back(one);
  }
  std::sort(modes.begin(), modes.end(), [](const Mode& a, const Mode& b) {
    return a.frequency != b.frequency ? a.frequency < b.frequency : a.number < b.number;
  });
  return modes;
}

/// Named rows of numbers, each name once.
struct NamedRows {
  std::vector<std::string> names;
  MatrixXd values;

  Index find(const std::string& name) const {
    const auto at = std::find(names.begin(), names.end(), name);
    return at == names.end() ? -1 : static_cast<Index>(at - names.begin());
  }
};

NamedRows read_rows(const CsvFile& table) {
  const std::size_t point = table.column("point");
  NamedRows out;
  out.values.resize(static_cast<Index>(table.rows.size()), static_cast<Index>(table.columns.size()) - 1);
  for (const CsvFile::Row& row : table.rows) {
    const std::string& name = row.cells[point];
    if (name.empty()) table.fail(row, "a point without name");
    if (out.find(name) >= 0) table.fail(row, fmt::format("point {} stands a second time", shortened(name)));
    const auto at = static_cast<Index>(out.names.size());
    out.names.push_back(name);
    Index column = 0;
    for (std::size_t c = 0; c < row.cells.size(); ++c)
      if (c != point) out.values(at, column++) = table.number(row, c);
  }
  return out;
}

std::vector<std::string> value_columns(const CsvFile& table) {
  std::vector<std::string> out = table.columns;
  out.erase(out.begin() + static_cast<std::ptrdiff_t>(table.column("point")));
  return out;
}

/// Shapes with a column for each mode, in the order of `modes`.
NamedRows read_shapes(const CsvFile& table, const std::vector<Mode>& modes, const std::string& modes_name) {
  NamedRows rows = read_rows(table);
  const std::vector<std::string> columns = value_columns(table);
  if (columns.size() != modes.size())
    throw FileError(fmt::format("{} has {} modes, {} {}", table.name, columns.size(), modes_name, modes.size()));
  MatrixXd ordered(rows.values.rows(), rows.values.cols());
  for (std::size_t k = 0; k < modes.size(); ++k) {
    const auto at = std::find(columns.begin(), columns.end(), std::to_string(modes[k].number));
    if (at == columns.end())
      throw FileError(fmt::format("{} has no column {}; expected one for each mode", table.name, modes[k].number));
    ordered.col(static_cast<Index>(k)) = rows.values.col(static_cast<Index>(at - columns.begin()));
  }
  rows.values = std::move(ordered);
  return rows;
}

std::string nearest_text(const std::string& name, const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(name, names);
  return nearest.empty() ? "" : "; nearest " + nearest;
}

/// A symmetric table over points, rows in the order of its columns.
NamedRows read_symmetric(const CsvFile& table, const NamedRows& shapes) {
  NamedRows rows = read_rows(table);
  const std::vector<std::string> columns = value_columns(table);
  for (const std::string& name : rows.names)
    if (shapes.find(name) < 0)
      throw FileError(fmt::format("{}: no point \"{}\" in the shapes{}", table.name, shortened(name),
                                  nearest_text(name, shapes.names)));
  if (columns.empty() || rows.names.empty()) throw FileError(table.name + " has no point; expected one or more");
  MatrixXd ordered(rows.values.rows(), rows.values.rows());
  if (columns.size() != rows.names.size())
    throw FileError(
        fmt::format("{} has {} rows and {} columns; expected as many", table.name, rows.names.size(), columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Index row = rows.find(columns[i]);
    if (row < 0)
      throw FileError(fmt::format("{}: no row of the column \"{}\"{}", table.name, shortened(columns[i]),
                                  nearest_text(columns[i], rows.names)));
    ordered.row(static_cast<Index>(i)) = rows.values.row(row);
  }
  rows.names = columns;
  rows.values = std::move(ordered);
  const double largest = rows.values.size() == 0 ? 0 : rows.values.cwiseAbs().maxCoeff();
  for (Index i = 0; i < rows.values.rows(); ++i)
    for (Index j = 0; j < i; ++j)
      if (std::abs(rows.values(i, j) - rows.values(j, i)) > most_asymmetry * largest)
        throw FileError(fmt::format("{} is not symmetric: {}, {} is {:.6g}, {}, {} is {:.6g}", table.name, columns[i],
                                    columns[j], rows.values(i, j), columns[j], columns[i], rows.values(j, i)));
  return rows;
}

/// V Λ Vᵀ, values below round-off of the largest left out.
SymmetricModes positive_part(const NamedRows& rows, const std::string& name, const char* unit) {
  SymmetricModes found = symmetric_modes((rows.values + rows.values.transpose()) / 2);
  const Index n = found.values.size();
  constexpr double round_off = 1e-12;
  const double largest = n == 0 ? 0 : std::max(std::abs(found.values[0]), std::abs(found.values[n - 1]));
  if (n > 0 && found.values[0] < -round_off * largest)
    throw FileError(fmt::format("{} is not positive semidefinite: eigenvalue {:.3g} {}", name, found.values[0], unit));
  const Index many = (found.values.array() > round_off * largest).count();
  found.vectors = found.vectors.rightCols(many).eval();
  found.values = found.values.tail(many).eval();
  return found;
}

SparseMatrix blocks(const VectorXd& diagonal, const MatrixXd& block) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto n = static_cast<int>(diagonal.size());
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, diagonal[i]);
  for (int i = 0; i < block.rows(); ++i)
    for (int j = 0; j < block.cols(); ++j)
      if (block(i, j) != 0) entries.emplace_back(n + i, n + j, (block(i, j) + block(j, i)) / 2);
  SparseMatrix out(n + block.rows(), n + block.rows());
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

/// Of all other modes: what stands beside the given ones.
struct Residual {
  NamedRows rows;
  SymmetricModes modes;
  MatrixXd mass;
};

Residual read_residual(const ModalFiles& files, const NamedRows& shapes) {
  Residual out;
  if (files.residual) {
    out.rows = read_symmetric(*files.residual, shapes);
    out.modes = positive_part(out.rows, files.residual->name, "m/N");
    out.mass = MatrixXd::Zero(out.modes.values.size(), out.modes.values.size());
  }
  if (!files.residual_mass) return out;
  if (!files.residual)
    throw FileError(files.residual_mass->name + " weighs a residual that is not given; expected residual too");
  const NamedRows mass = read_symmetric(*files.residual_mass, shapes);
  const std::vector<std::string>& names = out.rows.names;
  MatrixXd ordered(out.rows.values.rows(), out.rows.values.rows());
  for (std::size_t i = 0; i < names.size(); ++i)
    for (std::size_t j = 0; j < names.size(); ++j) {
      const Index row = mass.find(names[i]), column = mass.find(names[j]);
      if (row < 0 || column < 0 || mass.names.size() != names.size())
        throw FileError(fmt::format("{} has other points than {}", files.residual_mass->name, files.residual->name));
      ordered(static_cast<Index>(i), static_cast<Index>(j)) = mass.values(row, column);
    }
  positive_part({names, ordered}, files.residual_mass->name, "kg");
  out.mass = out.modes.vectors.transpose() * ordered * out.modes.vectors;
  return out;
}

/// Supports, and what they move and carry; the static modes by point. Those of the modes are η = M⁻¹Φᵀ(Mψ + M_fs e).
NamedRows add_supports(AssembledStructure& out, const ModalFiles& files, const NamedRows& shapes, Index modes) {
  NamedRows moved;
  if (files.static_modes) {
    moved = read_rows(*files.static_modes);
    out.supports = value_columns(*files.static_modes);
    for (const std::string& name : moved.names)
      if (shapes.find(name) < 0)
        throw FileError(fmt::format("{}: no point \"{}\" in the shapes{}", files.static_modes->name, shortened(name),
                                    nearest_text(name, shapes.names)));
  }
  const auto supports = static_cast<Index>(out.supports.size());
  out.static_modes = out.support_loads = MatrixXd::Zero(out.dofs(), supports);
  for (Index j = 0; j < supports; ++j) {
    const std::string& name = out.supports[static_cast<std::size_t>(j)];
    const Index row = shapes.find(name);
    if (row < 0)
      throw FileError(fmt::format("{}: no row of the support \"{}\", its participation in kg{}", files.shapes.name,
                                  shortened(name), nearest_text(name, shapes.names)));
    out.support_loads.col(j).head(modes) = shapes.values.row(row).transpose();
    for (Index k = 0; k < modes; ++k) out.static_modes(k, j) = out.support_loads(k, j) / out.mass.coeff(k, k);
  }
  return moved;
}

}  // namespace

AssembledStructure modal_structure(const ModalFiles& files, std::vector<double>& ratios) {
  const std::vector<Mode> modes = read_modes(files.modes);
  const NamedRows shapes = read_shapes(files.shapes, modes, files.modes.name);
  const auto count = static_cast<Index>(modes.size());
  const Residual residual = read_residual(files, shapes);
  const SymmetricModes& beside = residual.modes;
  AssembledStructure out;
  out.stiffness_name = files.modes.name;
  out.mass_name = files.modes.name;
  out.table_name = files.shapes.name;
  out.modes = ModalPart{static_cast<int>(count), {}, !files.residual || files.residual_mass.has_value()};
  VectorXd stiff(count), mass(count);
  int negative = 0;
  for (Index k = 0; k < count; ++k) {
    const Mode& one = modes[static_cast<std::size_t>(k)];
    mass[k] = one.mass;
    stiff[k] = one.stiffness();
    out.definite = out.definite && one.frequency > 0;
    if (one.frequency > 0) ratios.push_back(one.damping);
    negative += one.damping < 0 ? 1 : 0;
  }
  if (negative > 0)
    out.notes.push_back(fmt::format("{} mode{} gain{} energy from a damping ratio below 0", negative,
                                    negative == 1 ? "" : "s", negative == 1 ? "s" : ""));
  out.stiffness = blocks(stiff, MatrixXd(beside.values.cwiseInverse().asDiagonal()));
  out.mass = blocks(mass, residual.mass);
  for (Index l = 0; l < beside.values.size(); ++l) out.modes->attached.push_back(static_cast<int>(count + l));
  for (int k = 0; k < out.stiffness.rows(); ++k) {
    const int number = k < count ? modes[static_cast<std::size_t>(k)].number : k + 1;
    out.names.push_back({number, "mode", std::to_string(number), {}, ""});
  }
  out.where.resize(static_cast<std::size_t>(out.dofs()));
  for (int k = 0; k < out.dofs(); ++k)
    out.where[static_cast<std::size_t>(out.names[static_cast<std::size_t>(k)].dof) - 1].free = k;
  const NamedRows moved = add_supports(out, files, shapes, count);
  const auto supports = static_cast<Index>(out.supports.size());
  for (std::size_t i = 0; i < shapes.names.size(); ++i) {
    const std::string& name = shapes.names[i];
    if (std::find(out.supports.begin(), out.supports.end(), name) != out.supports.end()) continue;
    PlaceRow row;
    for (Index k = 0; k < count; ++k)
      if (const double value = shapes.values(static_cast<Index>(i), k); value != 0)
        row.free.emplace_back(static_cast<int>(k), value);
    if (const Index at = residual.rows.find(name); at >= 0)
      for (Index l = 0; l < beside.values.size(); ++l)
        if (beside.vectors(at, l) != 0) row.free.emplace_back(static_cast<int>(count + l), beside.vectors(at, l));
    // What the modes do not carry of the static mode.
    const Index at = moved.find(name);
    for (Index j = 0; j < supports; ++j) {
      double held = at >= 0 ? moved.values(at, j) : 0;
      for (const auto& [dof, value] : row.free) held -= value * out.static_modes(dof, j);
      if (held != 0) row.held.emplace_back(static_cast<int>(j), held);
    }
    out.modes->points[name] = std::move(row);
  }
  return out;
}

}  // namespace ricochet

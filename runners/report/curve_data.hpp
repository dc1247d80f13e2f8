#pragma once
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runners/store/record.hpp"

namespace ricochet::report {

/// Little-endian doubles as base64 (RFC 4648): exact, and shorter than decimal text.
std::string base64_doubles(std::span<const double> values);
/// Bytes as base64.
std::string base64_bytes(std::span<const unsigned char> bytes);

/// At most `limit` of n samples, chosen so that no peak is lost. First and last sample are kept. Those between are cut
/// into ⌊limit/2⌋ − 1 parts of equal counts. Of each part the smallest and the largest are kept, in their order.
/// Returns increasing indices; all when n ≤ limit or limit < 4.
std::vector<size_t> keep_extremes(std::span<const double> values, size_t limit);

/// The column of a curve, nothing where there is none (a refused case has no curve).
std::optional<std::span<const double>> curve_column(const Curve& curve, std::string_view name);

/// Numbers as base64, by "name:type".
using Blocks = std::map<std::string, std::string>;

/// The long columns of numbers that the page carries, each written once, whatever the number of charts that show it.
class CurveData {
 public:
  /// `limit`: largest number of samples of one series that the page carries.
  explicit CurveData(size_t limit) : limit_(limit) {}

  /// The names [x, y] of the blocks of both columns; nothing when the record has no such column.
  std::optional<nlohmann::ordered_json> series(const CaseRecord& record, const std::string& x, const std::string& y);
  /// Adds a block of little-endian numbers of `type` (f32, f64, u8, u16, u32); the page's script finds it as
  /// "key:type".
  void put(const std::string& key, const std::string& type, std::span<const unsigned char> bytes);
  /// Numbers in single precision.
  void put_floats(const std::string& key, std::span<const double> values);
  const Blocks& blocks() const { return blocks_; }
  /// Sentence on what was thinned out for display, "" when nothing was. `files`: whether each case has its curve's
  /// file.
  std::string thinning(bool files = true) const;

 private:
  size_t limit_;
  size_t thinned_ = 0, longest_ = 0;
  Blocks blocks_;
};

/// Blocks as the page carries them. One that shrinks by a fifth is packed, its key ends in z: first bytes of all
/// numbers, then their second ones, and so on, as gzip (RFC 1952), as base64.
Blocks packed_blocks(const Blocks& blocks);

/// Limit for CurveData such that curves take about 8 MB of the page: 6·10⁵ numbers shared by the series, at least 1000
/// samples each.
size_t sample_limit(size_t series);

}  // namespace ricochet::report

#include "runners/report/curve_data.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory>

namespace ricochet::report {
namespace {

constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

using Bytes = std::vector<unsigned char>;

Bytes from_base64(std::string_view text) {
  static const std::array<unsigned char, 256> values = [] {
    std::array<unsigned char, 256> out{};
    for (std::size_t k = 0; k < digits.size(); ++k)
      out[static_cast<unsigned char>(digits[k])] = static_cast<unsigned char>(k);
    return out;
  }();
  Bytes out;
  out.reserve(text.size() / 4 * 3);
  unsigned held = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    held = (held << 6) | values[static_cast<unsigned char>(c)];
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    out.push_back(static_cast<unsigned char>(held >> bits));
  }
  return out;
}

/// The same bytes as gzip, the same each time; empty where the library fails.
Bytes gzipped(const Bytes& bytes) {
  Bytes out;
  const std::unique_ptr<archive, decltype(&archive_write_free)> file{archive_write_new(), archive_write_free};
  const std::unique_ptr<archive_entry, decltype(&archive_entry_free)> entry{archive_entry_new(), archive_entry_free};
  archive* at = file.get();
  archive_entry_set_filetype(entry.get(), AE_IFREG);
  archive_entry_set_pathname(entry.get(), "block");
  const auto write = [](archive*, void* data, const void* some, std::size_t size) -> la_ssize_t {
    const auto* first = static_cast<const unsigned char*>(some);
    static_cast<Bytes*>(data)->insert(static_cast<Bytes*>(data)->end(), first, first + size);
    return static_cast<la_ssize_t>(size);
  };
  const bool done = archive_write_set_format_raw(at) == ARCHIVE_OK && archive_write_add_filter_gzip(at) == ARCHIVE_OK &&
                    archive_write_set_options(at, "gzip:!timestamp,gzip:compression-level=6") == ARCHIVE_OK &&
                    archive_write_set_bytes_in_last_block(at, 1) == ARCHIVE_OK &&
                    archive_write_open(at, &out, nullptr, write, nullptr) == ARCHIVE_OK &&
                    archive_write_header(at, entry.get()) == ARCHIVE_OK &&
                    archive_write_data(at, bytes.data(), bytes.size()) == static_cast<la_ssize_t>(bytes.size()) &&
                    archive_write_close(at) == ARCHIVE_OK;
  return done ? out : Bytes();
}

}  // namespace

Blocks packed_blocks(const Blocks& blocks) {
  Blocks out;
  for (const auto& [key, text] : blocks) {
    // The number behind the type's letter counts bits.
    const std::size_t width = static_cast<std::size_t>(std::stoi(key.substr(key.rfind(':') + 2))) / 8;
    const Bytes bytes = from_base64(text);
    Bytes turned;
    turned.reserve(bytes.size());
    for (std::size_t k = 0; k < width; ++k)
      for (std::size_t i = k; i < bytes.size(); i += width) turned.push_back(bytes[i]);
    const Bytes small = gzipped(turned);
    if (small.empty() || 5 * small.size() > 4 * bytes.size())
      out[key] = text;
    else
      out[key + "z"] = base64_bytes(small);
  }
  return out;
}

std::string base64_doubles(std::span<const double> values) {
  std::vector<unsigned char> bytes;
  bytes.reserve(values.size() * 8);
  for (const double value : values) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (int k = 0; k < 8; ++k) bytes.push_back(static_cast<unsigned char>(bits >> (8 * k)));
  }
  return base64_bytes(bytes);
}

std::string base64_bytes(std::span<const unsigned char> bytes) {
  const size_t length = bytes.size();
  const auto at = [&](size_t i) { return i < length ? unsigned{bytes[i]} : 0u; };
  std::string out;
  out.reserve((length + 2) / 3 * 4);
  for (size_t i = 0; i < length; i += 3) {
    const unsigned triple = (at(i) << 16) | (at(i + 1) << 8) | at(i + 2);
    out += digits[triple >> 18];
    out += digits[(triple >> 12) & 63];
    out += i + 1 < length ? digits[(triple >> 6) & 63] : '=';
    out += i + 2 < length ? digits[triple & 63] : '=';
  }
  return out;
}

std::vector<size_t> keep_extremes(std::span<const double> values, size_t limit) {
  const size_t n = values.size();
  std::vector<size_t> kept;
  if (n <= limit || limit < 4) {
    kept.resize(n);
    for (size_t i = 0; i < n; ++i) kept[i] = i;
    return kept;
  }
  const size_t bins = limit / 2 - 1;
  kept.push_back(0);
  for (size_t bin = 0; bin < bins; ++bin) {
    const size_t from = 1 + (n - 2) * bin / bins, to = 1 + (n - 2) * (bin + 1) / bins;
    size_t low = from, high = from;
    for (size_t i = from; i < to; ++i) {
      if (values[i] < values[low]) low = i;
      if (values[i] > values[high]) high = i;
    }
    kept.push_back(std::min(low, high));
    if (low != high) kept.push_back(std::max(low, high));
  }
  kept.push_back(n - 1);
  return kept;
}

std::optional<std::span<const double>> curve_column(const Curve& curve, std::string_view name) {
  for (size_t i = 0; i < curve.names.size() && i < curve.columns.size(); ++i)
    if (curve.names[i] == name) return std::span<const double>(curve.columns[i]);
  return std::nullopt;
}

std::optional<nlohmann::ordered_json> CurveData::series(const CaseRecord& record, const std::string& x,
                                                        const std::string& y) {
  const auto xs = curve_column(record.curve, x), ys = curve_column(record.curve, y);
  if (!xs || !ys || xs->empty() || xs->size() != ys->size()) return std::nullopt;
  const bool thin = ys->size() > limit_;
  const std::string x_key = record.id + "/" + x + (thin ? "@" + y : ""), y_key = record.id + "/" + y;
  const std::string type = ":f64";
  if (!blocks_.contains(y_key + type)) {
    if (thin) {
      std::vector<double> some_x, some_y;
      for (const size_t i : keep_extremes(*ys, limit_)) {
        some_x.push_back((*xs)[i]);
        some_y.push_back((*ys)[i]);
      }
      blocks_[x_key + type] = base64_doubles(some_x);
      blocks_[y_key + type] = base64_doubles(some_y);
      ++thinned_;
      longest_ = std::max(longest_, ys->size());
    } else {
      if (!blocks_.contains(x_key + type)) blocks_[x_key + type] = base64_doubles(*xs);
      blocks_[y_key + type] = base64_doubles(*ys);
    }
  }
  return nlohmann::ordered_json::array({x_key, y_key});
}

void CurveData::put(const std::string& key, const std::string& type, std::span<const unsigned char> bytes) {
  blocks_[key + ":" + type] = base64_bytes(bytes);
}

void CurveData::put_floats(const std::string& key, std::span<const double> values) {
  std::vector<unsigned char> bytes;
  bytes.reserve(values.size() * 4);
  for (const double value : values) {
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
    for (int k = 0; k < 4; ++k) bytes.push_back(static_cast<unsigned char>(bits >> (8 * k)));
  }
  put(key, "f32", bytes);
}

std::string CurveData::thinning(bool files) const {
  if (thinned_ == 0) return "";
  return fmt::format(
      "{} series of up to {} samples are thinned to {} for this page. The smallest and the largest sample of each "
      "small interval are kept, so no peak is lost. The full series are in the store{}.",
      thinned_, longest_, limit_, files ? " and in curves/" : "");
}

size_t sample_limit(size_t series) {
  return std::max<size_t>(1000, 600'000 / std::max<size_t>(series, 1));
}

}  // namespace ricochet::report

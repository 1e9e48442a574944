#include "io/npz/npy_array.hpp"

#include "base/memory_account.hpp"
#include "base/text/printable.hpp"
#include "io/checkpoint/bytes.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdint>
#include <optional>

namespace microtrace::io {
namespace {

/// The header of an array: a Python dictionary with three entries.
struct NpyHeader {
  std::optional<std::string> type;
  std::optional<bool> is_fortran;
  std::optional<std::vector<std::size_t>> shape;
};

/// Parses the header. Each function returns false if the text is something else.
class HeaderParser {
 public:
  explicit HeaderParser(std::string_view text) : text_(text) {}

  bool parse(NpyHeader& header) {
    if (!accept("{")) return false;
    while (!accept("}")) {
      std::string key;
      if (!string(key) || !accept(":") || !value(key, header)) return false;
      if (!accept(",") && !text_.starts_with('}')) return false;
    }
    return text_.empty() && header.type && header.is_fortran && header.shape;
  }

 private:
  bool accept(std::string_view word) {
    if (!text_.starts_with(word)) return false;
    text_.remove_prefix(word.size());
    text_.remove_prefix(std::min(text_.find_first_not_of(" \n"), text_.size()));
    return true;
  }

  bool string(std::string& value) {
    const std::size_t end = text_.find('\'', 1);
    if (!text_.starts_with('\'') || end == text_.npos) return false;
    value = text_.substr(1, end - 1);
    return accept(text_.substr(0, end + 1));
  }

  bool value(const std::string& key, NpyHeader& header) {
    if (key == "descr" && !header.type) return string(header.type.emplace());
    if (key == "fortran_order" && !header.is_fortran) {
      header.is_fortran = text_.starts_with("True");
      return accept("True") || accept("False");
    }
    return key == "shape" && !header.shape && tuple(header.shape.emplace());
  }

  bool tuple(std::vector<std::size_t>& numbers) {
    constexpr std::size_t kMaxDimensions = 32;
    if (!accept("(")) return false;
    while (!accept(")")) {
      std::size_t number = 0;
      const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), number);
      if (error != std::errc() || numbers.size() == kMaxDimensions) return false;
      numbers.push_back(number);
      accept(text_.substr(0, static_cast<std::size_t>(end - text_.data())));
      if (!accept(",") && !text_.starts_with(')')) return false;
    }
    return true;
  }

  std::string_view text_;
};

double value_of(std::string_view type, ByteReader& bytes) {
  if (type == "<f8") return std::bit_cast<double>(bytes.number<std::uint64_t>());
  if (type == "<f4")
    return static_cast<double>(std::bit_cast<float>(bytes.number<std::uint32_t>()));
  if (type == "<i8")
    return static_cast<double>(static_cast<std::int64_t>(bytes.number<std::uint64_t>()));
  if (type == "<i4")
    return static_cast<double>(static_cast<std::int32_t>(bytes.number<std::uint32_t>()));
  if (type == "<u8") return static_cast<double>(bytes.number<std::uint64_t>());
  return static_cast<double>(bytes.number<std::uint32_t>());
}

bool is_known(std::string_view type) {
  return type.size() == 3 && type[0] == '<' && std::string_view("fiu").find(type[1]) != type.npos &&
         (type[2] == '4' || type[2] == '8');
}

/// Returns the position in row-major order of the next value in column-major order, and advances
/// `index` to it.
std::size_t next_position(std::vector<std::size_t>& index, const std::vector<std::size_t>& shape) {
  std::size_t position = 0;
  for (std::size_t i = 0; i < shape.size(); ++i) position = position * shape[i] + index[i];
  for (std::size_t i = 0; i < shape.size() && ++index[i] == shape[i]; ++i) index[i] = 0;
  return position;
}

}  // namespace

std::string shape_text(const std::vector<std::size_t>& shape) {
  std::string text = "(";
  for (const std::size_t extent : shape)
    text.append(text.size() > 1 ? ", " : "").append(std::to_string(extent));
  return text + (shape.size() == 1 ? ",)" : ")");
}

NpyArray read_npy(std::string_view bytes, const std::string& file, const std::string& name) {
  const auto fail = [&](const std::string& message) {
    throw Error(ErrorKind::invalid_scene, file, "array " + printable(name) + ": " + message);
  };
  constexpr std::string_view kMagic = "\x93NUMPY";
  ByteReader reader(bytes);
  const auto magic = reader.take(kMagic.size());
  const auto major = reader.number<std::uint8_t>();
  (void)reader.number<std::uint8_t>();
  const std::size_t size =
      major == 1 ? reader.number<std::uint16_t>() : reader.number<std::uint32_t>();
  const auto text = reader.take(size);
  NpyHeader header;
  if (magic != kMagic || major < 1 || major > 3 || reader.is_short() || !text)
    fail("is not in the format .npy; write it with numpy.savez");
  if (!HeaderParser(*text).parse(header))
    fail("has a header that is not understood; it must be an array of numbers");
  if (!is_known(*header.type)) {
    fail("has the type " + printable(*header.type) +
         "; convert it to float64 with numpy.asarray(..., dtype='<f8')");
  }
  const std::size_t value_size = (*header.type)[2] == '8' ? 8 : 4;
  std::size_t count = 1;
  for (const std::size_t extent : *header.shape) {
    if (extent != 0 && count > reader.left() / extent) fail("is cut off");
    count *= extent;
  }
  if (reader.left() % value_size != 0 || count != reader.left() / value_size)
    fail("has the shape " + shape_text(*header.shape) + ", but another number of values");
  take_memory(count * sizeof(double), "the values of " + file);
  NpyArray array{.shape = *header.shape, .values = std::vector<double>(count)};
  std::vector<std::size_t> index(array.shape.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = *header.is_fortran ? next_position(index, array.shape) : i;
    array.values[at] = value_of(*header.type, reader);
  }
  return array;
}

}  // namespace microtrace::io

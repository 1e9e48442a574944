#include "dataset/annotations/npz.hpp"

#include "base/crc32.hpp"
#include "base/little_endian.hpp"

#include <microtrace/error.hpp>

#include <limits>
#include <set>
#include <string_view>

namespace microtrace::dataset {
namespace {

template <class Number>
constexpr std::string_view kType = "<f4";
template <>
constexpr std::string_view kType<std::uint32_t> = "<u4";
template <>
constexpr std::string_view kType<std::uint8_t> = "|u1";

/// Returns the .npy file of an array, format version 1.0: its data begin at a multiple of 64 bytes.
std::string npy(const NpzArray& array) {
  std::size_t count = 1;
  std::string shape = "(";
  for (const std::size_t extent : array.shape) {
    if (extent != 0 && count > std::numeric_limits<std::size_t>::max() / extent)
      throw Error(ErrorKind::usage, array.name, "the shape is too large");
    count *= extent;
    shape += std::to_string(extent) + (array.shape.size() == 1 ? "," : ", ");
  }
  if (array.shape.size() > 1) shape.resize(shape.size() - 2);
  shape += ")";
  return std::visit(
      [&]<class Number>(std::span<const Number> values) {
        if (values.size() != count)
          throw Error(ErrorKind::usage, array.name,
                      "the shape " + shape + " needs " + std::to_string(count) + " values, not " +
                          std::to_string(values.size()));
        std::string header("{'descr': '");
        header.append(kType<Number>).append("', 'fortran_order': False, 'shape': ");
        header.append(shape).append(", }");
        constexpr std::size_t kPrefix = 10;
        header.resize((kPrefix + header.size() + 1 + 63) / 64 * 64 - kPrefix - 1, ' ');
        header += '\n';
        std::string file("\x93NUMPY\1\0", 8);
        append_little(file, static_cast<std::uint16_t>(header.size()));
        file += header;
        file.reserve(file.size() + values.size_bytes());
        for (const Number value : values) append_little(file, value);
        return file;
      },
      array.values);
}

/// Returns the part of a file's header that occurs both before the file and in the archive's
/// directory.
std::string common_header(std::string_view name, std::string_view file) {
  constexpr std::uint16_t kUtf8 = 1 << 11;         // names are UTF-8
  constexpr std::uint16_t kFirstDay = 1 << 5 | 1;  // January 1, 1980
  std::string header;
  for (const std::uint16_t number : {std::uint16_t{20}, kUtf8, std::uint16_t{0}, std::uint16_t{0},
                                     kFirstDay})  // version, flags, stored, time
    append_little(header, number);
  append_little(header, crc32(file));
  append_little(header, static_cast<std::uint32_t>(file.size()));
  append_little(header, static_cast<std::uint32_t>(file.size()));
  append_little(header, static_cast<std::uint16_t>(name.size()));
  append_little(header, std::uint16_t{0});  // no extra field
  return header;
}

}  // namespace

std::string npz(std::span<const NpzArray> arrays) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (arrays.size() > std::numeric_limits<std::uint16_t>::max())
    throw Error(ErrorKind::limit, "", "a .npz file has at most 65535 arrays");
  std::string archive, directory;
  std::set<std::string_view> names;
  for (const NpzArray& array : arrays) {
    const std::string name = array.name + ".npy";
    if (array.name.empty() || name.size() > std::numeric_limits<std::uint16_t>::max() ||
        !names.insert(array.name).second)
      throw Error(ErrorKind::usage, array.name, "arrays need different names");
    const std::string file = npy(array);
    if (archive.size() + directory.size() + file.size() + 4 * name.size() + 256 > kMost)
      throw Error(ErrorKind::limit, array.name,
                  "a .npz file has at most 4 GiB; store fewer arrays");
    const std::string header = common_header(name, file);
    directory.append("PK\1\2\x14\0", 6).append(header);
    directory.append(10, '\0');  // no comment; disk 0; attributes
    append_little(directory, static_cast<std::uint32_t>(archive.size()));
    directory += name;
    archive.append("PK\3\4").append(header).append(name).append(file);
  }
  const auto start = static_cast<std::uint32_t>(archive.size());
  archive += directory;
  archive.append("PK\5\6\0\0\0\0", 8);
  append_little(archive, static_cast<std::uint16_t>(arrays.size()));
  append_little(archive, static_cast<std::uint16_t>(arrays.size()));
  append_little(archive, static_cast<std::uint32_t>(directory.size()));
  append_little(archive, start);
  append_little(archive, std::uint16_t{0});  // no comment
  return archive;
}

}  // namespace microtrace::dataset

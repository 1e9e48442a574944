/// Decodes images with OpenEXR, behind the C interface of io/image/module_abi.hpp. Reads from
/// memory, because only the library accesses files.

#include "io/image/module_abi.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using Imath::Box2i;

constexpr int kMaxSide = 65536;  // equals microtrace's limit for environment maps

/// An input file in memory.
class MemoryFile : public Imf::IStream {
 public:
  MemoryFile(const char* bytes, std::size_t size)
      : IStream("picture.exr"), bytes_(bytes), size_(size) {}

  bool read(char* to, int count) override {
    const auto wanted = static_cast<std::size_t>(count);
    if (place_ > size_ || size_ - place_ < wanted) throw std::runtime_error("the file ends early");
    std::memcpy(to, bytes_ + place_, wanted);
    place_ += wanted;
    return place_ < size_;
  }
  std::uint64_t tellg() override { return place_; }
  void seekg(std::uint64_t place) override { place_ = static_cast<std::size_t>(place); }

 private:
  const char* bytes_;
  std::size_t size_, place_ = 0;
};

/// Returns the names of R, G and B outside of layers, or of the first layer that has all three, and
/// of A of the same layer if it exists. Empty if there are no such channels.
std::vector<std::string> rgb_of(const Imf::ChannelList& channels) {
  std::vector<std::string> layers{""};
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
    const std::string name = channel.name();
    if (name.ends_with(".R")) layers.push_back(name.substr(0, name.size() - 1));
  }
  for (const std::string& layer : layers) {
    std::vector<std::string> names{layer + "R", layer + "G", layer + "B"};
    const auto is_there = [&](const std::string& name) { return channels.findChannel(name); };
    if (!std::ranges::all_of(names, is_there)) continue;
    if (is_there(layer + "A")) names.push_back(layer + "A");
    return names;
  }
  return {};
}

/// Returns the names of the color channels, and of alpha if it exists. For gray images, the name is
/// Y or that of the only channel.
std::vector<std::string> colors_of(const Imf::ChannelList& channels) {
  std::vector<std::string> rgb = rgb_of(channels);
  if (!rgb.empty()) return rgb;
  if (channels.findChannel("RY") != nullptr || channels.findChannel("BY") != nullptr)
    throw std::runtime_error("its colors are luminance and chroma; convert it to R, G and B");
  if (channels.findChannel("Y") != nullptr) {
    if (channels.findChannel("A") != nullptr) return {"Y", "A"};
    return {"Y"};
  }
  auto first = channels.begin();
  if (first != channels.end() && ++channels.begin() == channels.end()) return {first.name()};
  throw std::runtime_error("it has neither channels R, G and B nor a single one");
}

std::int32_t distance(int from, int to) {
  const std::int64_t difference = std::int64_t{to} - from;
  if (difference != static_cast<std::int32_t>(difference))
    throw std::runtime_error("its windows are too far apart");
  return static_cast<std::int32_t>(difference);
}

/// The number of pixels between two numbers, which are included.
std::uint32_t length(int first, int last) {
  return static_cast<std::uint32_t>(std::int64_t{last} - first + 1);
}

/// Reads the colors of a file or of one of its parts.
template <class File>
void decode(File& file, bool has_further, const MicrotraceColorSink& sink) {
  const Imf::ChannelList& channels = file.header().channels();
  const std::vector<std::string> names = colors_of(channels);
  for (const std::string& name : names) {
    const Imf::Channel& channel = channels[name];
    if (channel.xSampling != 1 || channel.ySampling != 1)
      throw std::runtime_error("its channel " + name + " does not have a sample for each pixel");
  }
  const Box2i window = file.header().dataWindow(), whole = file.header().displayWindow();
  const MicrotraceColors colors{.width = length(window.min.x, window.max.x),
                                .height = length(window.min.y, window.max.y),
                                .channels = static_cast<std::uint32_t>(names.size()),
                                .number = kMicrotraceF32,
                                .is_unassociated = 0,
                                .has_further = has_further ? 1 : 0,
                                .x0 = distance(whole.min.x, window.min.x),
                                .y0 = distance(whole.min.y, window.min.y),
                                .whole_width = length(whole.min.x, whole.max.x),
                                .whole_height = length(whole.min.y, whole.max.y)};
  auto* samples = static_cast<float*>(sink.begin(sink.context, &colors));
  if (samples == nullptr) throw std::runtime_error("it is too large");
  const std::size_t stride = names.size() * sizeof(float);
  Imf::FrameBuffer pixels;
  for (std::size_t i = 0; i < names.size(); ++i) {
    pixels.insert(names[i],
                  Imf::Slice::Make(Imf::FLOAT, samples + i, window, stride, stride * colors.width));
  }
  file.setFrameBuffer(pixels);
  file.readPixels(window.min.y, window.max.y);
}

/// Returns the numbers of the parts that have colors.
std::vector<int> parts_with_colors(const Imf::MultiPartInputFile& file) {
  std::vector<int> parts;
  for (int part = 0; part < file.parts(); ++part) {
    const Imf::Header& header = file.header(part);
    const bool is_deep = header.hasType() && Imf::isDeepData(header.type());
    if (!is_deep && !rgb_of(header.channels()).empty()) parts.push_back(part);
  }
  return parts;
}

void decode(const char* bytes, std::size_t size, const MicrotraceColorSink& sink) {
  // Makes OpenEXR reject larger images before it allocates memory for their lines.
  Imf::Header::setMaxImageSize(kMaxSide, kMaxSide);
  MemoryFile memory(bytes, size);
  bool has_further = false;
  {
    Imf::MultiPartInputFile file(memory, 0);  // 0: no threads
    const std::vector<int> parts = parts_with_colors(file);
    has_further = parts.size() > 1;
    if (!parts.empty() && parts.front() != 0) {
      Imf::InputPart part(file, parts.front());
      return decode(part, has_further, sink);
    }
  }
  memory.seekg(0);
  Imf::InputFile file(memory, 0);
  decode(file, has_further, sink);
}

}  // namespace

extern "C" {

__attribute__((visibility("default"))) int microtrace_decode_colors_v4(
    const void* bytes, std::size_t size, const char* /*extension*/,
    const MicrotraceColorSink* sink) {
  try {
    decode(static_cast<const char*>(bytes), size, *sink);
    return 1;
  } catch (const std::exception& e) {
    sink->complain(sink->context, e.what());
    return 0;
  }
}
}

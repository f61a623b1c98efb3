#include "image/exr.h"

#include <cerrno>
#include <cstring>
#include <exception>
#include <fstream>

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <fmt/format.h>

#include "sys/atomic_file.h"
#include "sys/parallel.h"

namespace kd::image {

namespace {

bool buffers_fit(const Film& film) {
  const size_t pixels = size_t{film.width} * film.height;
  if (pixels == 0 || film.colour.size() != 4 * pixels) return false;
  for (const AovBuffer& buffer : film.aovs) {
    if (buffer.words.size() != static_cast<size_t>(aov_row(buffer.aov).components) * pixels) return false;
  }
  return true;
}

/// One channel of an interleaved buffer, in the header and in the frame buffer. A Slice's base is not const because
/// slices serve reading too; writing a file only reads from it.
void add_channel(Imf::Header& header, Imf::FrameBuffer& frame, std::string_view name, Imf::PixelType type,
                 const void* first, int components, uint32_t width) {
  const size_t pixel = sizeof(float) * static_cast<size_t>(components);
  const Imath::V2i origin = header.dataWindow().min;
  header.channels().insert(std::string(name), Imf::Channel(type));
  frame.insert(std::string(name), Imf::Slice::Make(type, first, origin, width, 0, pixel, pixel * width));
}

void add_channels(Imf::Header& header, Imf::FrameBuffer& frame, const Film& film) {
  constexpr std::array<std::string_view, 4> kColour{"R", "G", "B", "A"};
  for (size_t c = 0; c < kColour.size(); ++c) {
    add_channel(header, frame, kColour[c], Imf::FLOAT, film.colour.data() + c, 4, film.width);
  }
  for (const AovBuffer& buffer : film.aovs) {
    const AovRow& row = aov_row(buffer.aov);
    const Imf::PixelType type = row.type == ChannelType::float32 ? Imf::FLOAT : Imf::UINT;
    for (size_t c = 0; c < static_cast<size_t>(row.components); ++c) {
      add_channel(header, frame, row.channels[c], type, buffer.words.data() + c, row.components, film.width);
    }
  }
}

Imath::M44f matrix(const Matrix4& m) {
  Imath::M44f out;
  for (int i = 0; i < 16; ++i) out[i / 4][i % 4] = m[static_cast<size_t>(i)];
  return out;
}

void add_attributes(Imf::Header& file, const ExrHeader& header) {
  if (header.gamma) file.insert("gamma", Imf::FloatAttribute(static_cast<float>(*header.gamma)));
  if (!header.software.empty()) file.insert("software", Imf::StringAttribute(header.software));
  for (const auto& [name, value] : header.text) file.insert(name, Imf::StringAttribute(value));
  for (const auto& [name, value] : header.numbers) file.insert(name, Imf::DoubleAttribute(value));
  Imf::addChromaticities(file, Imf::Chromaticities());  // whose default they are
  if (header.world_to_camera) Imf::addWorldToCamera(file, matrix(*header.world_to_camera));
  if (header.world_to_ndc) Imf::addWorldToNDC(file, matrix(*header.world_to_ndc));
}

/// Throws what OpenEXR throws. False: the file system would not take it all, errno says why.
bool write_film(const std::string& path, const Film& film, const ExrHeader& header) {
  const auto box = [](uint32_t column, uint32_t row, uint32_t width, uint32_t height) {
    const auto x = static_cast<int>(column), y = static_cast<int>(row);
    return Imath::Box2i({x, y}, {x + static_cast<int>(width) - 1, y + static_cast<int>(height) - 1});
  };
  const Imath::Box2i data = box(film.column, film.row, film.width, film.height);
  const Imath::Box2i display = film.picture_width > 0 ? box(0, 0, film.picture_width, film.picture_height) : data;
  Imf::Header file_header(display, data);
  file_header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer frame;
  add_channels(file_header, frame, film);
  add_attributes(file_header, header);

  // Blocks of lines are compressed side by side; the bytes are the same for any number of threads.
  const auto threads = static_cast<int>(thread_count());
  if (Imf::globalThreadCount() < threads) Imf::setGlobalThreadCount(threads);

  // OutputFile's destructor writes the line table and swallows what goes wrong then; the stream remembers it.
  std::ofstream stream(path, std::ios::binary);
  if (!stream) return false;
  {
    Imf::StdOFStream exr_stream(stream, path.c_str());
    Imf::OutputFile file(exr_stream, file_header, threads);
    file.setFrameBuffer(frame);
    file.writePixels(static_cast<int>(film.height));
  }
  stream.close();
  return !stream.fail();
}

}  // namespace

std::optional<std::string> read_exr_text(const std::string& path, const std::string& name) {
  try {
    Imf::InputFile file(path.c_str());
    const auto* text = file.header().findTypedAttribute<Imf::StringAttribute>(name);
    if (!text || !file.isComplete()) return std::nullopt;
    const char* last_block = nullptr;  // in the file as in the picture: what is cut short lacks it
    int size = 0;
    file.rawPixelData(file.header().dataWindow().max.y, last_block, size);
    return text->value();
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

Result<void> write_exr(const std::string& path, const Film& film, const ExrHeader& header) {
  if (!buffers_fit(film)) return Error{ErrorClass::output, path, "cannot write: the film's buffers lack its size"};
  auto file = AtomicFile::create(path);
  if (!file) return file.error();
  try {
    errno = 0;
    if (!write_film(file->temporary_path(), film, header)) {
      return Error{ErrorClass::output, path, fmt::format("cannot write: {}", std::strerror(errno))};
    }
  } catch (const std::exception& e) {
    return Error{ErrorClass::output, path, fmt::format("cannot write: {}", e.what())};
  }
  return file->commit();
}

}  // namespace kd::image

// OpenEXR pictures, in memory on this side of the library so that files stay atomic and damage is testable.

#include "lamella/core/error.h"
#include "lamella/io/detail/light_image.h"

#include <fmt/format.h>

#ifdef LAMELLA_HAS_EXR
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#endif

namespace lamella::io {

#ifdef LAMELLA_HAS_EXR
namespace {

constexpr const char* kChannels[] = {"R", "G", "B", "A"};

class MemoryOut : public Imf::OStream {
public:
    MemoryOut() : Imf::OStream("memory") {}
    void write(const char* bytes, int count) override {
        const auto n = static_cast<std::size_t>(count);
        if (contents.size() < at_ + n) contents.resize(at_ + n);
        std::memcpy(contents.data() + at_, bytes, n);
        at_ += n;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t position) override { at_ = position; }

    std::string contents;

private:
    std::size_t at_ = 0;
};

class MemoryIn : public Imf::IStream {
public:
    MemoryIn(std::string_view contents, const std::string& name) : Imf::IStream(name.c_str()), contents_(contents) {}
    bool read(char* bytes, int count) override {
        const auto n = static_cast<std::size_t>(count);
        if (at_ > contents_.size() || n > contents_.size() - at_) throw InputError("it ends too early");
        std::memcpy(bytes, contents_.data() + at_, n);
        at_ += n;
        return at_ < contents_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t position) override { at_ = position; }

private:
    std::string_view contents_;
    std::size_t at_ = 0;
};

/// The picture's memory as the library wants it described, for the first `channels` of RGBA.
Imf::FrameBuffer described(LightImage& image, int left, int top) {
    const auto step = static_cast<std::size_t>(image.channels) * sizeof(float);
    // The library addresses pixel (x, y) of the file at base + x * step + y * row, wherever the file's window lies.
    char* base = reinterpret_cast<char*>(image.values.data()) - (top * static_cast<std::ptrdiff_t>(image.width) + left) *
                                                                    static_cast<std::ptrdiff_t>(step);
    Imf::FrameBuffer buffer;
    for (int k = 0; k < image.channels; ++k)
        buffer.insert(kChannels[k], Imf::Slice(Imf::FLOAT, base + k * static_cast<std::ptrdiff_t>(sizeof(float)), step,
                                               step * image.width, 1, 1, 0.0));
    return buffer;
}

}  // namespace

bool has_exr() { return true; }

std::string exr_bytes(const LightImage& picture) {
    LightImage copy = picture;
    Imf::Header header(static_cast<int>(picture.width), static_cast<int>(picture.height));
    header.compression() = Imf::ZIP_COMPRESSION;
    for (int k = 0; k < picture.channels; ++k) header.channels().insert(kChannels[k], Imf::Channel(Imf::FLOAT));
    MemoryOut out;
    try {
        Imf::OutputFile file(out, header);
        file.setFrameBuffer(described(copy, 0, 0));
        file.writePixels(static_cast<int>(picture.height));
    } catch (const std::exception& error) {
        throw IoError(fmt::format("OpenEXR cannot store a picture: {}", error.what()));
    }
    return std::move(out.contents);
}

LightImage detail::parse_exr(std::string_view contents, const std::string& name) {
    try {
        MemoryIn in(contents, name);
        Imf::InputFile file(in);
        const auto window = file.header().dataWindow();
        LightImage image;
        image.width = static_cast<std::size_t>(static_cast<std::int64_t>(window.max.x) - window.min.x + 1);
        image.height = static_cast<std::size_t>(static_cast<std::int64_t>(window.max.y) - window.min.y + 1);
        if (image.width > (1U << 20) || image.height > (1U << 20) || image.width * image.height > kMostPixels)
            throw InputError("it is too large");
        if (file.header().channels().findChannel("R") == nullptr) throw InputError("it has no channels R, G, B");
        image.values.resize(image.width * image.height * 3);
        file.setFrameBuffer(described(image, window.min.x, window.min.y));
        file.readPixels(window.min.y, window.max.y);
        for (const float value : image.values)
            if (!std::isfinite(value)) throw InputError("it has pixels that are not finite");
        return image;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw InputError(fmt::format("{}: this OpenEXR picture cannot be read: {}", name, error.what()));
    }
}
#else
bool has_exr() { return false; }

std::string exr_bytes(const LightImage&) {
    throw InputError("this lamella was built without OpenEXR; choose a .png file, or install libopenexr-dev and build again");
}

LightImage detail::parse_exr(std::string_view, const std::string& name) {
    throw InputError(fmt::format("{}: this lamella was built without OpenEXR; install libopenexr-dev and build again, or "
                                 "convert the file to Radiance's .hdr",
                                 name));
}
#endif

}  // namespace lamella::io

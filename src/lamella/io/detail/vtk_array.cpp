#include "lamella/io/detail/vtk_array.h"

#include "lamella/core/parallel.h"
#include "lamella/io/detail/base64.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdint>
#include <cstring>
#include <new>
#include <vector>

namespace lamella::io::detail {
namespace {

static_assert(std::endian::native == std::endian::little, "frames are written in the byte order of the machine");

constexpr std::size_t kBlock = std::size_t{1} << 18;  ///< bytes per zlib block: 32 k doubles, enough to fill threads
constexpr std::size_t kSample = 8192;
constexpr std::size_t kMostBlocks = std::size_t{1} << 32;

std::string deflate(std::string_view bytes, int level) {
    std::string out(compressBound(bytes.size()), '\0');
    uLongf size = out.size();
    if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                  bytes.size(), level) != Z_OK) {
        throw std::bad_alloc();  // the only error left: the output fits by compressBound
    }
    out.resize(size);
    return out;
}

std::size_t blocks_of(std::size_t bytes) { return (bytes + kBlock - 1) / kBlock; }
std::size_t header_bytes(std::size_t blocks) { return sizeof(std::uint64_t) * (3 + blocks); }

/// One zlib block: level 1, or stored where a sample from its middle shrinks by less than a tenth. The random mantissas
/// of positions or velocities give 5 % at 20 MB/s; storing them runs at 1800 MB/s (2.5 GHz Xeon, one core). Neighbor
/// lists, labels and smooth fields shrink to 10..55 % at level 1, and level 6 gains under 2 % more at a third
/// of the speed.
std::string deflate_block(std::string_view block) {
    if (block.size() > 4 * kSample) {
        const std::string_view sample = block.substr((block.size() - kSample) / 2, kSample);
        if (10 * deflate(sample, 1).size() > 9 * sample.size()) return deflate(block, 0);
    }
    return deflate(block, 1);
}

void append_word(std::string& out, std::size_t value) {
    const std::uint64_t word = value;
    out.append(reinterpret_cast<const char*>(&word), sizeof word);
}

std::size_t word_at(std::string_view bytes, std::size_t index) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + sizeof word * index, sizeof word);
    return word;
}

}  // namespace

std::size_t longest_vtk_array(std::size_t bytes) {
    const std::size_t blocks = blocks_of(bytes);
    return base64_length(header_bytes(blocks)) + base64_length(blocks * compressBound(kBlock));
}

VtkArrayWriter::VtkArrayWriter(AtomicFile& file, std::size_t at, std::size_t bytes)
    : file_(file),
      header_at_(at),
      at_(at + base64_length(header_bytes(blocks_of(bytes)))),
      bytes_(bytes),
      missing_(bytes) {}

void VtkArrayWriter::put(std::string_view bytes) {
    const std::size_t batch = kBlock * std::max<std::size_t>(16, 4 * static_cast<std::size_t>(thread_count()));
    missing_ -= bytes.size();
    while (!bytes.empty()) {
        const std::string_view now = bytes.substr(0, batch - pending_.size());
        bytes.remove_prefix(now.size());
        const bool last = missing_ == 0 && bytes.empty();
        if (pending_.empty() && (now.size() == batch || last)) {
            write_blocks(now);
            continue;
        }
        pending_ += now;
        if (pending_.size() < batch && !last) continue;
        write_blocks(pending_);
        pending_.clear();
    }
}

/// Whole blocks, or the last ones.
void VtkArrayWriter::write_blocks(std::string_view bytes) {
    std::vector<std::string> blocks(blocks_of(bytes.size()));
    parallel_blocks(bytes.size(), kBlock, [&](std::size_t begin, std::size_t end) {
        blocks[begin / kBlock] = deflate_block(bytes.substr(begin, end - begin));
    });
    for (const std::string& block : blocks) {
        size_.push_back(block.size());
        uncoded_ += block;
    }
    const bool last = size_.size() == blocks_of(bytes_);
    const std::size_t groups = last ? uncoded_.size() : uncoded_.size() / 3 * 3;
    std::string text;
    append_base64(text, std::string_view(uncoded_).substr(0, groups));
    uncoded_.erase(0, groups);
    file_.write_at(at_, text);
    at_ += text.size();
}

std::size_t VtkArrayWriter::finish() {
    std::string header;
    append_word(header, size_.size());
    append_word(header, kBlock);
    append_word(header, bytes_ % kBlock);
    for (const std::uint64_t size : size_) append_word(header, size);
    std::string text;
    append_base64(text, header);
    file_.write_at(header_at_, text);
    return at_;
}

struct VtkArrayReader::Header {
    std::size_t size = 0;   ///< bytes of the array
    std::size_t block = 0;  ///< bytes of every block but the last
    std::vector<std::size_t> compressed;
    std::size_t text_length = 0;
};

InputError VtkArrayReader::damaged(const std::string& array, const std::string& what) const {
    return InputError({name_}, fmt::format("the data of \"{}\" are damaged: {}", array, what));
}

VtkArrayReader::Header VtkArrayReader::read_header(const std::string& array) const {
    const auto start = decode_base64(rest(), 24);
    if (!start) throw damaged(array, "the file ends early, or is not base64");
    const std::size_t blocks = word_at(*start, 0);
    Header header;
    header.block = word_at(*start, 1);
    const std::size_t partial = word_at(*start, 2);
    if (blocks > kMostBlocks || header.block > kMostBlocks || (blocks > 0 && partial >= header.block)) {
        throw damaged(array, "impossible block sizes");
    }
    const auto words = decode_base64(rest(), 8 * (3 + blocks));  // as long as the text, so memory is bounded by it
    if (!words) throw damaged(array, "the file ends early, or is not base64");
    for (std::size_t b = 0; b < blocks; ++b) {
        header.compressed.push_back(word_at(*words, 3 + b));
        const std::size_t raw = b + 1 == blocks && partial > 0 ? partial : header.block;
        // Deflate cannot shrink further than 1032 : 1, so what memory is taken stays in proportion to the file.
        if (header.compressed.back() > text_.size() || raw > 1032 * header.compressed.back() + 64) {
            throw damaged(array, "impossible block sizes");
        }
        header.size += raw;
    }
    header.text_length = base64_length(words->size());
    return header;
}

std::string VtkArrayReader::read(const std::string& array, std::size_t expected) {
    const Header header = read_header(array);
    if (header.size != expected) {
        throw damaged(array, fmt::format("{} bytes instead of {}", header.size, expected));
    }
    return inflate(array, header, expected);
}

std::string VtkArrayReader::read_at_most(const std::string& array, std::size_t limit) {
    const Header header = read_header(array);
    if (header.size > limit) throw damaged(array, fmt::format("{} bytes, at most {} expected", header.size, limit));
    return inflate(array, header, header.size);
}

std::string VtkArrayReader::inflate(const std::string& array, const Header& header, std::size_t size) {
    std::vector<std::size_t> start(header.compressed.size() + 1, 0);
    for (std::size_t b = 0; b < header.compressed.size(); ++b) start[b + 1] = start[b] + header.compressed[b];
    const auto data = decode_base64(rest().substr(header.text_length), start.back());
    if (!data) throw damaged(array, "the file ends early, or is not base64");

    std::string bytes(size, '\0');
    std::atomic<bool> good = true;
    parallel_blocks(header.compressed.size(), 1, [&](std::size_t b, std::size_t) {
        const std::size_t begin = b * header.block;
        const std::size_t raw = std::min(size - begin, header.block);
        uLongf got = raw;
        uLong used = header.compressed[b];
        const int code = uncompress2(reinterpret_cast<Bytef*>(bytes.data() + begin), &got,
                                     reinterpret_cast<const Bytef*>(data->data() + start[b]), &used);
        if (code != Z_OK || got != raw || used != header.compressed[b]) good = false;
    });
    if (!good) throw damaged(array, "a compressed block does not have the right content");
    position_ += header.text_length + base64_length(data->size());
    return bytes;
}

}  // namespace lamella::io::detail

#pragma once

#include "lamella/core/error.h"
#include "lamella/io/detail/output_file.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::io::detail {

/// The most characters that an array of so many bytes takes in a file.
std::size_t longest_vtk_array(std::size_t bytes);

/// Writes a data array the way VTK's XML files store it (header_type UInt64, vtkZLibDataCompressor, base64): the
/// header [blocks, block bytes, bytes of a partial last block, compressed bytes of each block] as one base64 text,
/// then all zlib blocks as another. The array comes in pieces, of which few are in memory at once. The same text
/// whatever the pieces, on any number of threads.
class VtkArrayWriter {
public:
    /// @param at     where in the file its text begins
    /// @param bytes  of the whole array
    VtkArrayWriter(AtomicFile& file, std::size_t at, std::size_t bytes);

    /// Bytes that are still to come.
    std::size_t missing() const { return missing_; }
    /// The next of them. @throws IoError
    void put(std::string_view bytes);
    /// Once nothing is missing: where the text ends. @throws IoError
    std::size_t finish();

private:
    void write_blocks(std::string_view bytes);

    AtomicFile& file_;
    std::size_t header_at_, at_;
    std::size_t bytes_, missing_;
    std::string pending_;              ///< bytes that came, too few for blocks of their own
    std::string uncoded_;              ///< compressed bytes that fill no base64 group yet
    std::vector<std::uint64_t> size_;  ///< compressed bytes of each block
};

/// Reads arrays back, one after the other, from the text that VtkArrayWriter made.
class VtkArrayReader {
public:
    /// @param name  the file, for messages
    VtkArrayReader(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {}

    /// Offset of the next array.
    std::size_t position() const { return position_; }
    std::string_view rest() const { return text_.substr(position_); }

    /// The next array, of exactly `expected` bytes. Memory is taken only for what the compressed bytes can hold.
    /// @throws InputError  it is damaged or has another size; `array` names it
    std::string read(const std::string& array, std::size_t expected);
    /// The next array, of any size up to `limit` bytes (text).
    std::string read_at_most(const std::string& array, std::size_t limit);

private:
    struct Header;
    Header read_header(const std::string& array) const;
    std::string inflate(const std::string& array, const Header& header, std::size_t size);
    InputError damaged(const std::string& array, const std::string& what) const;

    std::string_view text_;
    std::string name_;
    std::size_t position_ = 0;
};

}  // namespace lamella::io::detail

#pragma once

#include "lamella/core/error.h"

#include <cstddef>
#include <string>
#include <string_view>

namespace lamella::io::detail {

/// Appends a data array the way VTK's XML files store it (header_type UInt64, vtkZLibDataCompressor, base64): the
/// header [blocks, block bytes, bytes of a partial last block, compressed bytes of each block] as one base64 text,
/// then all zlib blocks as another. The same bytes on any number of threads.
void append_vtk_array(std::string& out, std::string_view bytes);

/// Reads arrays back, one after the other, from the text that append_vtk_array made.
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

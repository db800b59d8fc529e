#pragma once

#include <span>
#include <string_view>

namespace lamella::app::view {

/// A file of the page, built from web/ and linked into the program, so that it works offline and anywhere.
struct PageFile {
    std::string_view path;  ///< "/", "/page.js"
    std::string_view type;  ///< "text/html; charset=utf-8"
    std::string_view content;
};

/// Empty when this program was built without npm.
std::span<const PageFile> page_files();

}  // namespace lamella::app::view

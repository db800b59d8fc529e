// ParaView collections: the list of the frames of a run with their times.

#include "lamella/core/error.h"
#include "lamella/io/atomic_file.h"
#include "lamella/io/detail/xml.h"
#include "lamella/io/frame_files.h"

#include <fmt/format.h>

#include <charconv>

namespace lamella::io {
namespace {

using detail::XmlScanner;
using detail::XmlToken;

FrameEntry read_entry(const XmlScanner& xml, XmlToken& token) {
    FrameEntry entry{.file = token.attributes["file"]};
    const std::string& time = token.attributes["timestep"];
    const auto result = std::from_chars(time.data(), time.data() + time.size(), entry.time);
    if (result.ec != std::errc() || result.ptr != time.data() + time.size()) {
        throw xml.error(fmt::format("timestep = \"{}\" of a DataSet is not a number", time));
    }
    if (entry.file.empty()) throw xml.error("a DataSet has no file");
    return entry;
}

}  // namespace

void write_pvd(const std::filesystem::path& path, const std::vector<FrameEntry>& entries) {
    std::string text =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
        "byte_order=\"LittleEndian\">\n<Collection>\n";
    for (const FrameEntry& entry : entries) {
        if (entry.file.empty() || !detail::is_printable(entry.file)) {
            throw InputError(fmt::format("{}: a frame's file name is empty or not UTF-8 on one line", path.string()));
        }
        text += fmt::format("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", shortest_text(entry.time),
                            detail::xml_escaped(entry.file));
    }
    write_file_atomically(path, text + "</Collection>\n</VTKFile>\n");
}

std::vector<FrameEntry> read_pvd(const std::filesystem::path& path) {
    return parse_pvd(read_file(path), path.string());
}

std::vector<FrameEntry> parse_pvd(std::string_view text, const std::string& name) {
    XmlScanner xml(text, name);
    XmlToken token = xml.next();
    if (token.name != "VTKFile" || token.attributes["type"] != "Collection") {
        throw xml.error("is not a ParaView collection: <VTKFile type=\"Collection\"> was expected");
    }
    std::vector<FrameEntry> entries;
    while (token.kind != XmlToken::Kind::kEnd || token.name != "VTKFile") {
        token = xml.next();
        if (token.kind == XmlToken::Kind::kEndOfFile) throw xml.error("the file ends early: </VTKFile> is missing");
        if (token.kind == XmlToken::Kind::kStart && token.name == "DataSet") entries.push_back(read_entry(xml, token));
    }
    return entries;
}

}  // namespace lamella::io

#include "lamella/io/csv.h"

#include "lamella/core/error.h"
#include "lamella/io/atomic_file.h"
#include "lamella/io/detail/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <optional>

namespace lamella::io {
namespace {

/// A field as RFC 4180 wants it: in quotes, with quotes doubled, when it holds a separator.
void append_field(std::string& line, std::string_view field) {
    if (field.find_first_of(",\"\r\n") == std::string_view::npos) {
        line += field;
        return;
    }
    line += '"';
    for (const char c : field) line.append(c == '"' ? 2 : 1, c);
    line += '"';
}

}  // namespace

std::string csv_line(const std::vector<std::string>& fields) {
    std::string line;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        if (i > 0) line += ',';
        append_field(line, fields[i]);
    }
    line += '\n';
    return line;
}

struct CsvWriter::Impl {
    std::filesystem::path path;
    detail::FileDescriptor file;
    std::uint64_t size = 0;  ///< bytes of complete rows

    void append_line(std::string_view line) {
        try {
            detail::write_all(file, line, path);
        } catch (const IoError&) {
            // Part of the line may be there. Should cutting it off fail as well, the first error tells more.
            if (::ftruncate(file.get(), static_cast<off_t>(size)) == 0) ::lseek(file.get(), 0, SEEK_END);
            throw;
        }
        size += line.size();
    }
};

void CsvWriter::ImplDeleter::operator()(Impl* impl) const { delete impl; }
CsvWriter::~CsvWriter() = default;
CsvWriter::CsvWriter(CsvWriter&&) noexcept = default;
CsvWriter& CsvWriter::operator=(CsvWriter&&) noexcept = default;

CsvWriter::CsvWriter(std::filesystem::path path, const std::vector<std::string>& header)
    : impl_(new Impl{.path = std::move(path), .file = {}}) {
    impl_->file = detail::FileDescriptor(::open(impl_->path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    if (!impl_->file) detail::throw_io_error("write", impl_->path, errno);
    append_text(header);
}

CsvWriter::CsvWriter(std::filesystem::path path, std::uint64_t offset)
    : impl_(new Impl{.path = std::move(path), .file = {}, .size = offset}) {
    impl_->file = detail::FileDescriptor(::open(impl_->path.c_str(), O_RDWR | O_CLOEXEC));
    const int fd = impl_->file.get();
    struct stat info {};
    if (!impl_->file || ::fstat(fd, &info) != 0) detail::throw_io_error("continue", impl_->path, errno);
    if (static_cast<std::uint64_t>(info.st_size) < offset) {
        throw InputError({impl_->path.string()},
                         fmt::format("has {} bytes, but had {} when the checkpoint was written; it cannot be continued",
                                     info.st_size, offset));
    }
    char last = '\n';
    const auto end = static_cast<off_t>(offset);
    if (offset > 0 && ::pread(fd, &last, 1, end - 1) != 1) detail::throw_io_error("continue", impl_->path, errno);
    if (last != '\n') {
        throw InputError({impl_->path.string()},
                         fmt::format("no row ends at byte {}, where the checkpoint left it; it was changed", offset));
    }
    if (::ftruncate(fd, end) != 0 || ::lseek(fd, end, SEEK_SET) != end) {
        detail::throw_io_error("continue", impl_->path, errno);
    }
}

void CsvWriter::append(const std::vector<double>& row) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
        if (i > 0) line += ',';
        append_shortest(line, row[i]);
    }
    line += '\n';
    impl_->append_line(line);
}

void CsvWriter::append_text(const std::vector<std::string>& row) { impl_->append_line(csv_line(row)); }

std::uint64_t CsvWriter::sync() {
    if (::fsync(impl_->file.get()) != 0) detail::throw_io_error("write", impl_->path, errno);
    return impl_->size;
}

int CsvTable::column(const std::string& name) const {
    for (std::size_t i = 0; i < header.size(); ++i) {
        if (header[i] == name || header[i].starts_with(name + "[")) return static_cast<int>(i);
    }
    return -1;
}

namespace {

/// Takes a CSV text apart, record by record, and knows its line for messages.
class CsvScanner {
public:
    CsvScanner(std::string_view text, const std::string& name) : text_(text), name_(name) {}

    std::vector<std::string> header() {
        auto fields = next_record();
        if (!fields) throw InputError({name_}, "is empty; a header line was expected");
        return std::move(*fields);
    }

    /// The next record, which must have as many fields as the header; nothing at the end of the text.
    std::optional<std::vector<std::string>> next_row(std::size_t columns) {
        auto fields = next_record();
        if (fields && fields->size() != columns)
            throw error(fmt::format("{} values, but the header has {} columns", fields->size(), columns));
        return fields;
    }

    InputError error(const std::string& message) const { return InputError({name_, record_line_, 0}, message); }

private:
    /// The fields of the next record that is not blank; nothing at the end of the text.
    std::optional<std::vector<std::string>> next_record() {
        while (position_ < text_.size()) {
            record_line_ = line_;
            std::vector<std::string> fields = record();
            if (fields.size() > 1 || !fields[0].empty()) return fields;
        }
        return std::nullopt;
    }

    std::vector<std::string> record() {
        std::vector<std::string> fields(1);
        bool quoted = false;
        for (; position_ < text_.size(); ++position_) {
            const char c = text_[position_];
            if (c == '\n') ++line_;
            if (quoted) {
                if (c != '"') {
                    fields.back() += c;
                } else if (next_is('"')) {
                    fields.back() += '"';
                    ++position_;
                } else {
                    quoted = false;
                }
            } else if (c == '\n') {
                ++position_;
                return fields;
            } else if (c == '"' && fields.back().empty()) {
                quoted = true;
            } else if (c == ',') {
                fields.emplace_back();
            } else if (c != '\r' || !next_is('\n')) {
                fields.back() += c;
            }
        }
        if (quoted) throw error("a quoted field is not closed");
        return fields;
    }

    bool next_is(char c) const { return position_ + 1 < text_.size() && text_[position_ + 1] == c; }

    std::string_view text_;
    const std::string& name_;
    std::size_t position_ = 0;
    int line_ = 1;
    int record_line_ = 1;
};

double parse_number(const std::string& field, const std::string& column, const CsvScanner& scanner) {
    double value = 0.0;
    const auto [end, code] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (code != std::errc() || end != field.data() + field.size()) {
        throw scanner.error(fmt::format("{} = \"{}\" is not a number", column, field.substr(0, 40)));
    }
    return value;
}

}  // namespace

CsvTable read_csv(const std::filesystem::path& path) { return parse_csv(read_file(path), path.string()); }

CsvTable parse_csv(std::string_view text, const std::string& name) {
    CsvScanner scanner(text, name);
    CsvTable table;
    table.header = scanner.header();
    while (const auto fields = scanner.next_row(table.header.size())) {
        std::vector<double>& row = table.rows.emplace_back();
        row.reserve(fields->size());
        for (std::size_t i = 0; i < fields->size(); ++i) {
            row.push_back(parse_number((*fields)[i], table.header[i], scanner));
        }
    }
    return table;
}

CsvTextTable read_csv_text(const std::filesystem::path& path) {
    const std::string text = read_file(path), name = path.string();
    CsvScanner scanner(text, name);
    CsvTextTable table;
    table.header = scanner.header();
    while (auto fields = scanner.next_row(table.header.size())) table.rows.push_back(std::move(*fields));
    return table;
}

}  // namespace lamella::io

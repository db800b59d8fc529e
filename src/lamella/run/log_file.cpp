#include "lamella/run/log_file.h"

#include "lamella/core/error.h"

#include <spdlog/logger.h>
#include <spdlog/sinks/basic_file_sink.h>

namespace lamella::run {
namespace {

spdlog::level::level_enum spdlog_level(LogLevel level) {
    switch (level) {
        case LogLevel::kDebug:
            return spdlog::level::debug;
        case LogLevel::kInfo:
            return spdlog::level::info;
        case LogLevel::kWarning:
            return spdlog::level::warn;
        case LogLevel::kError:
            break;
    }
    return spdlog::level::err;
}

}  // namespace

struct LogFile::Impl {
    spdlog::logger logger;
};

LogFile::LogFile(const std::filesystem::path& path) {
    try {
        auto sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>(path.string());
        impl_.reset(new Impl{spdlog::logger("lamella", std::move(sink))});
    } catch (const spdlog::spdlog_ex& error) {
        throw IoError(error.what());
    }
    impl_->logger.set_pattern("%Y-%m-%dT%H:%M:%S.%e%z %l %v");
    impl_->logger.set_level(spdlog::level::debug);
    impl_->logger.flush_on(spdlog::level::debug);
    impl_->logger.set_error_handler([](const std::string&) {});  // spdlog would print to stderr
}

LogFile::~LogFile() = default;

void LogFile::write(LogLevel level, std::string_view message) { impl_->logger.log(spdlog_level(level), message); }

}  // namespace lamella::run

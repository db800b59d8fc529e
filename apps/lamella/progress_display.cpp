#include "progress_display.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

namespace lamella::app {
namespace {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

std::size_t terminal_width() {
    winsize size{};
    constexpr std::size_t kUsual = 80;
    return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsual;
}

}  // namespace

ProgressStyle progress_style(const std::string& name) {
    if (name == "bar") return ProgressStyle::kBar;
    if (name == "plain") return ProgressStyle::kPlain;
    if (name == "none") return ProgressStyle::kNone;
    return ::isatty(STDERR_FILENO) != 0 ? ProgressStyle::kBar : ProgressStyle::kPlain;
}

ProgressDisplay::ProgressDisplay(ProgressStyle style) : style_(style) {}

ProgressDisplay::~ProgressDisplay() { clear(); }

void ProgressDisplay::show(const run::RunProgress& progress) {
    if (style_ == ProgressStyle::kNone) return;
    const double time = now();
    if (progress.stage != stage_) {
        stage_ = progress.stage;
        stage_start_ = time;
        estimate_ = {};
        if (style_ == ProgressStyle::kPlain) last_shown_ = time;
    }
    if (progress.fraction) estimate_.update(time - stage_start_, std::clamp(*progress.fraction, 0.0, 1.0));

    const double interval = style_ == ProgressStyle::kBar ? 0.1 : 5.0;  // [s]
    if (time - last_shown_ < interval) return;
    last_shown_ = time;
    if (style_ == ProgressStyle::kBar)
        draw_bar(progress);
    else
        fmt::print(stderr, "{}\n", status(progress));
    drawn_ = style_ == ProgressStyle::kBar;
}

void ProgressDisplay::clear() {
    if (drawn_) fmt::print(stderr, "\r\x1b[K");
    drawn_ = false;
}

std::string ProgressDisplay::status(const run::RunProgress& progress) const {
    std::string text;
    if (progress.stage == "run") {
        text = fmt::format("time {:.5g}{}  step {}  frames {}", progress.time,
                           progress.time_unit == "-" ? "" : " " + progress.time_unit, progress.step, progress.frames);
    } else {
        text = progress.text.empty() ? progress.stage : fmt::format("{}: {}", progress.stage, progress.text);
    }
    if (progress.fraction) text = fmt::format("{:3.0f} %  {}", 100.0 * *progress.fraction, text);
    if (const auto left = estimate_.seconds_left()) text += fmt::format("  {} left", duration_text(*left));
    return text;
}

void ProgressDisplay::draw_bar(const run::RunProgress& progress) const {
    std::string line = status(progress);
    const std::size_t width = terminal_width() - 1;
    if (progress.fraction && width > line.size() + 12) {
        const std::size_t room = std::min<std::size_t>(width - line.size() - 3, 40);
        const auto filled =
            static_cast<std::size_t>(std::clamp(*progress.fraction, 0.0, 1.0) * static_cast<double>(room));
        line = fmt::format("[{}{}] {}", std::string(filled, '#'), std::string(room - filled, '.'), line);
    }
    fmt::print(stderr, "\r{}\x1b[K", line.substr(0, width));
    std::fflush(stderr);
}

}  // namespace lamella::app

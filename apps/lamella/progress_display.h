#pragma once

#include "lamella/core/progress.h"
#include "lamella/run/run.h"

#include <string>

namespace lamella::app {

enum class ProgressStyle {
    kBar,    ///< one line that is drawn over
    kPlain,  ///< a line every few seconds
    kNone,
};

/// The style that the user names: bar, plain, none; "" is a bar on a terminal, else plain.
ProgressStyle progress_style(const std::string& name);

/// Shows on standard error how far a run is and how long it will take.
class ProgressDisplay {
public:
    explicit ProgressDisplay(ProgressStyle style);
    ~ProgressDisplay();  ///< leaves the cursor at the start of an empty line

    void show(const run::RunProgress& progress);
    /// Removes the bar, so that other text can be written.
    void clear();

private:
    std::string status(const run::RunProgress& progress) const;
    void draw_bar(const run::RunProgress& progress) const;

    ProgressStyle style_;
    ProgressEstimate estimate_;
    std::string stage_;
    double stage_start_ = 0.0;  ///< [s]
    double last_shown_ = 0.0;   ///< [s]
    bool drawn_ = false;
};

}  // namespace lamella::app

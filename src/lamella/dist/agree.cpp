#include "lamella/dist/agree.h"

#include "lamella/core/error.h"
#include "lamella/dist/sum.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

namespace lamella::dist::detail {
namespace {

enum class Kind : std::int64_t { kInput, kIo, kNumerical, kInterrupted, kOther };

/// An error as it travels.
struct Telegram {
    Kind kind = Kind::kOther;
    std::array<char, 2000> text{};
};

Telegram telegram_of(const std::exception_ptr& error) {
    Telegram telegram;
    const auto set = [&](Kind kind, const std::exception& e) {
        telegram.kind = kind;
        std::strncpy(telegram.text.data(), e.what(), telegram.text.size() - 1);
    };
    try {
        std::rethrow_exception(error);
    } catch (const InputError& e) {
        set(Kind::kInput, e);
    } catch (const IoError& e) {
        set(Kind::kIo, e);
    } catch (const NumericalError& e) {
        set(Kind::kNumerical, e);
    } catch (const Interrupted& e) {
        set(Kind::kInterrupted, e);
    } catch (const std::exception& e) {
        set(Kind::kOther, e);
    }
    return telegram;
}

[[noreturn]] void rethrow(const Telegram& telegram, int rank) {
    const std::string text = fmt::format("{} (process {})", telegram.text.data(), rank);
    switch (telegram.kind) {
        case Kind::kInput:
            throw InputError(text);
        case Kind::kIo:
            throw IoError(text);
        case Kind::kInterrupted:
            throw Interrupted();
        case Kind::kNumerical:
        case Kind::kOther:
            break;
    }
    throw NumericalError(text);
}

}  // namespace

void agree_on_failure(Communicator& processes, const std::exception_ptr& error) {
    const double own = error ? static_cast<double>(processes.size() - processes.rank()) : 0.0;
    const double first = largest(processes, own);
    if (first == 0.0) return;
    const int culprit = processes.size() - static_cast<int>(first);

    Telegram telegram;
    std::vector<Outgoing> outgoing;
    std::vector<Incoming> incoming;
    if (own == first) {
        telegram = telegram_of(error);
        for (int r = 0; r < processes.size(); ++r)
            if (r != culprit) outgoing.push_back({r, std::as_bytes(std::span(&telegram, 1))});
    } else {
        incoming.push_back({culprit, std::as_writable_bytes(std::span(&telegram, 1))});
    }
    processes.begin(outgoing, incoming);
    processes.end();
    if (own == first) std::rethrow_exception(error);
    rethrow(telegram, culprit);
}

}  // namespace lamella::dist::detail

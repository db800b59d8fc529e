#include "lamella/dist/sum.h"

#include <vector>

namespace lamella::dist {

void reduce(Communicator& processes, std::span<FixedSum> sums, std::span<double> maxima) {
    if (!processes.several()) return;
    std::vector<std::int64_t> words;
    words.reserve(2 * sums.size());
    for (FixedSum& sum : sums) {
        sum.carry();  // so that the low integers of very many processes have room
        words.push_back(sum.high());
        words.push_back(sum.low());
    }
    processes.reduce(words, maxima);
    for (std::size_t k = 0; k < sums.size(); ++k) {
        sums[k].high() = words[2 * k];
        sums[k].low() = words[2 * k + 1];
    }
}

std::int64_t sum(Communicator& processes, std::int64_t value) {
    processes.sum(std::span(&value, 1));
    return value;
}

double largest(Communicator& processes, double value) {
    processes.largest(std::span(&value, 1));
    return value;
}

}  // namespace lamella::dist

#include "view/colors.h"

#include "lamella/optics/film_color_table.h"

#include "view/message.h"
#include <span>

namespace lamella::app::view {

std::string color_message() {
    const optics::FilmColorTable table;
    const optics::TableSize& size = table.size();
    const std::size_t thin = size.thicknesses * size.cosines;
    const std::span<const float> values(table.values().front().data(), 3 * table.values().size());
    Message message;
    message.add("colors", "thin", "-", 3, values.first(3 * thin));
    message.add("colors", "thick", "-", 3, values.subspan(3 * thin));
    constexpr double kNanometer = 1e-9;
    return message.finish({{"thicknesses", size.thicknesses},
                           {"cosines", size.cosines},
                           {"max_thickness_nm", size.max_thickness / kNanometer},
                           {"reference_index", table.reference_index()}});
}

}  // namespace lamella::app::view

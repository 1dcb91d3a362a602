// A plugin of a renderer with the static library in it.
#include <welkin/welkin.hpp>

extern "C" float plugin_luminance();

float plugin_luminance() {
    return welkin::ColourSky(welkin::Model::default_model(), {}).xyz({0.0f, 0.0f, 1.0f})[1];
}

// Images from bytes: pixels that can all be sampled, or a message.
#include "input/image.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

static void promise(bool kept)
{
    if (!kept)
        abort();
}

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    ax_image image;
    ax_error error = {0};
    if (ax_image_parse("a.png", data, size, &image, &error) == AX_OK) {
        const double lo[2] = {-1, -1}, hi[2] = {1, 1};
        for (int k = 0; k < 100; ++k) {
            double value = ax_image_at(&image, lo, hi, (double[]){-1.1 + 0.022 * k, 1.1 - 0.0022 * k});
            promise(value >= 0 && value <= 1);
        }
    } else
        promise(!image.grey && error.message[strlen(error.message) - 1] == '.');
    ax_image_free(&image);
    return 0;
}

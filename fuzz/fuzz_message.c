// What a page sends to the studio is not trusted: no message may crash the reader, and what is refused says why.
#include "studio/message.h"

#include <stdint.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    message m;
    ax_error error = {0};
    if (message_read((const char*)data, size, &m, &error) != AX_OK) {
        if (!*error.message || error.status != AX_USAGE)
            abort();
    } else {
        json_t* step = NULL;
        const char* text = NULL;
        double to[3];
        int number = 0;
        if (!*m.action || m.id < 0)
            abort();
        message_unpack(&m, &error, "{s:i, s:o}", "serial", &number, "operator", &step);
        message_unpack(&m, &error, "{s:i, s:[F, F, F], s?i}", "hinge", &number, "to", &to[0], &to[1], &to[2], "serial",
                       &number);
        message_unpack(&m, &error, "{s?s, s?i}", "path", &text, "ahead", &number);
    }
    message_free(&m);
    return 0;
}

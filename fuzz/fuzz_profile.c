// Machine profiles from arbitrary bytes: refused, or within the ranges that writers rely on.
#include "fabricate/profile.h"

#include <stdint.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    ax_profile profile;
    if (ax_profile_parse((const char*)data, size, &profile, NULL) != AX_OK)
        return 0;
    if (!(profile.travel_speed > 0))
        abort();
    for (int k = 0; k < AX_OPERATIONS; ++k) {
        const ax_profile_pen* pen = &profile.pens[k];
        if (!*pen->layer || pen->aci < 1 || pen->aci > 255 || !(pen->stroke > 0) || !(pen->speed > 0 || k == AX_NOTE))
            abort();
    }
    return 0;
}

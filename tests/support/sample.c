#include "support/sample.h"

#include "support/shapes.h"
#include "support/test.h"

ax_design sample_design(void)
{
    ax_mesh cap = shape_cap(12, 0.9);
    ax_design_options options = ax_design_options_default();
    options.triangles = 100;
    options.unit = AX_METRE;
    ax_design design;
    ax_error error = {0};
    ax_status status = ax_design_from_target(&cap, &options, NULL, &design, &error);
    ax_mesh_free(&cap);
    if (status != AX_OK)
        fail_msg("the sample design failed: %s", error.message);
    return design;
}

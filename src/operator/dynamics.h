// What operators share that set the form in motion.
#pragma once

#include "operator/operator.h"

typedef struct ax_motion {
    bool adapt, adopt;
    double give;
} ax_motion;

// Rows of the field table of arguments that have `ax_motion motion`.
#define AX_MOTION_ADAPT(T)                                                                                             \
    {                                                                                                                  \
        .name = "adapt", .title = "Sizes adapt", .unit = "", .kind = AX_FIELD_FLAG,                                    \
        .offset = offsetof(T, motion.adapt),                                                                           \
        .doc = "Panel sizes may give way a little, so that holes open fully within rim and constraints."               \
    }
#define AX_MOTION_GIVE(T)                                                                                              \
    {                                                                                                                  \
        .name = "give", .title = "Give", .unit = "", .kind = AX_FIELD_NUMBER, .hi = 100,                               \
        .offset = offsetof(T, motion.give), .doc = "How easily sizes give way."                                        \
    }
#define AX_MOTION_ADOPT(T)                                                                                             \
    {                                                                                                                  \
        .name = "adopt", .title = "Shape is the design", .unit = "", .kind = AX_FIELD_FLAG,                            \
        .offset = offsetof(T, motion.adopt),                                                                           \
        .doc = "Finishing takes the loaded shape as the designed one, instead of the fully open one beside it."        \
    }
ax_motion ax_motion_default(void);
// From now on the form moves in this way. Collisions in the plane stay as they were.
void ax_motion_set(const ax_operator_context* context, ax_dynamics_kind kind, const ax_load* load,
                   const ax_motion* motion);

// What this build needs of its processor: data only, compiled for the processor that is asked
// about.
#include "apps/processor_features.h"

namespace lightwalk {

#define LIGHTWALK_TEXT(x) #x
#define LIGHTWALK_IS_ONE(name, macro) LIGHTWALK_TEXT(macro)[0] == '1',
const bool kNeededFeatures[] = {LIGHTWALK_PROCESSOR_FEATURES(LIGHTWALK_IS_ONE)};

}  // namespace lightwalk

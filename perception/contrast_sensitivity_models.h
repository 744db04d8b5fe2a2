#pragma once

#include "perception/contrast_sensitivity.h"

/// The formulas behind `csf_list`. Internal: use contrast_sensitivity.h, which checks arguments;
/// here frequency is finite and > 0, luminance > 0.
namespace perception::csf_models {

double mannos_sakrison(double frequency_cpd, double luminance_cd_m2, const StimulusConditions&);
double daly(double frequency_cpd, double luminance_cd_m2, const StimulusConditions&);
double daly_refitted(double frequency_cpd, double luminance_cd_m2, const StimulusConditions&);
double barten_1989(double frequency_cpd, double luminance_cd_m2, const StimulusConditions&);
double barten_1989_field(double frequency_cpd, double luminance_cd_m2, const StimulusConditions&);
double barten_1999(double frequency_cpd, double luminance_cd_m2, const StimulusConditions&);
double barten_2003(double frequency_cpd, double luminance_cd_m2, const StimulusConditions&);
double castle_achromatic(double frequency_cpd, double luminance_cd_m2, const StimulusConditions&);
double castle_red_green(double frequency_cpd, double luminance_cd_m2, const StimulusConditions&);
double castle_violet_yellow(double frequency_cpd, double luminance_cd_m2,
                            const StimulusConditions&);
double hdr_vdp2(double frequency_cpd, double luminance_cd_m2, const StimulusConditions&);
double hdr_vdp3(double frequency_cpd, double luminance_cd_m2, const StimulusConditions&);

}  // namespace perception::csf_models

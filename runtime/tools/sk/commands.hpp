// SPDX-License-Identifier: MIT
//
// The commands of sk, each in a folder of its own.
#pragma once

namespace CLI {
class App;
}

namespace sk_tool {

/// `sk info`: the devices of this machine, their capacity, arithmetic and speed, as a table for people or as JSON for programs. Measured
/// once per driver.
void addInfo(CLI::App& app);

/// `sk accuracy`: measures time and error of each choice of precision, storage, accumulation and functions on a device, in one run, and
/// writes a table, JSON and a chart.
void addAccuracy(CLI::App& app);

/// `sk scale`: predicts how the kernels of a file scale over many devices.
void addScale(CLI::App& app);

/// `sk serve`: a page with an editor for .sk files, their messages, their GLSL and their picture, for the browsers of this machine
/// alone.
void addServe(CLI::App& app);

/// `sk shadow`: prints the report of a program that ran beside its reference (SK_SHADOW), and writes its page again.
void addShadow(CLI::App& app);
/// `sk stress`: runs a program with what its kernels are given at the ends, and says where it breaks.
void addStress(CLI::App& app);
/// `sk tune`: finds the cheapest configuration file with which the results of a program are as exact as asked.
void addTune(CLI::App& app);

}  // namespace sk_tool

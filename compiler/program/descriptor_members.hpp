// SPDX-License-Identifier: MIT
//
// Private to stub_source.cpp: asserts that it knows every member of the descriptors that it prints.
#pragma once

#include <cstddef>

#include "program/member_count.hpp"
#include "sk/program.hpp"

namespace skc::emit {

template <class T, std::size_t Count>
constexpr bool printsAll = memberCount<T>() == Count;

static_assert(printsAll<sk::program::Field, 5> && printsAll<sk::program::Element, 4> &&
                  printsAll<sk::program::ConditionStep, 3> && printsAll<sk::program::Condition, 2> &&
                  printsAll<sk::program::Layer, 3> && printsAll<sk::program::Parameter, 24> &&
                  printsAll<sk::program::Reach, 5> && printsAll<sk::program::IntrinsicUse, 3> &&
                  printsAll<sk::program::Table, 4> && printsAll<sk::program::TableUse, 2> &&
                  printsAll<sk::program::Kernel, 25> && printsAll<sk::program::UnrolledKernel, 3> &&
                  printsAll<sk::program::PassOperand, 2> && printsAll<sk::program::Pass, 2> &&
                  printsAll<sk::program::ArgumentPlane, 2> && printsAll<sk::program::Bundle, 3> &&
                  printsAll<sk::program::Plan, 5> && printsAll<sk::program::SumTerm, 2> &&
                  printsAll<sk::program::Reduction, 12> && printsAll<sk::program::FoldParts, 5> &&
                  printsAll<sk::program::WideReduction, 2> && printsAll<sk::program::CompensatedSum, 2> &&
                  printsAll<sk::program::CompensatedReduction, 4> && printsAll<sk::program::ExactSum, 6>,
              "a descriptor has another member: print it, then correct its count");

}  // namespace skc::emit

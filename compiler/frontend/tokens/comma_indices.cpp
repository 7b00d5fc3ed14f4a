// SPDX-License-Identifier: MIT
#include "frontend/tokens/comma_indices.hpp"

#include <algorithm>

#include "frontend/clang_loc.hpp"
#include "frontend/tokens/token_cursor.hpp"

namespace skc::frontend {
namespace {

using clang::Token;
namespace tok = clang::tok;
using Tokens = std::vector<Token>;

struct Subscripts {
  int indices = 0;
  Tokens commas;   ///< between indices in one pair of brackets
};

/// Parses `[i][j, k]` from its first bracket.
Subscripts subscriptsAt(const Tokens& body, std::size_t at) {
  Subscripts result;
  int depth = 0;
  for (; at + 1 < body.size() && body[at].isNot(tok::semi); ++at) {
    const Token& token = body[at];
    if (token.is(tok::l_square) && depth == 0) ++result.indices;
    if (token.isOneOf(tok::l_paren, tok::l_square, tok::l_brace)) ++depth;
    if (token.isOneOf(tok::r_paren, tok::r_square, tok::r_brace)) --depth;
    if (depth == 0 && body[at + 1].isNot(tok::l_square)) break;
    if (token.is(tok::less)) at = std::max(at, endOfList(body, at));
    if (token.is(tok::comma) && depth == 1) {
      ++result.indices;
      result.commas.push_back(token);
    }
  }
  return result;
}

const IndexedParameter* named(const Token& token, const std::vector<IndexedParameter>& parameters) {
  if (token.isNot(tok::identifier)) return nullptr;
  for (const IndexedParameter& parameter : parameters) {
    if (parameter.name.getIdentifierInfo() == token.getIdentifierInfo()) return &parameter;
  }
  return nullptr;
}

}  // namespace

void rejectCommaIndices(const Tokens& body, const std::vector<IndexedParameter>& parameters,
                        Diagnostics& diagnostics) {
  for (std::size_t i = 1; i + 1 < body.size(); ++i) {
    const bool isMember = body[i - 1].isOneOf(tok::period, tok::coloncolon);
    const IndexedParameter* parameter = isMember ? nullptr : named(body[i], parameters);
    if (parameter == nullptr || parameter->rank < 2 || body[i + 1].isNot(tok::l_square)) continue;
    const Subscripts subscripts = subscriptsAt(body, i + 1);
    if (subscripts.commas.empty()) continue;
    std::vector<FixIt> fixIts;
    if (subscripts.indices == parameter->rank) {
      for (const Token& comma : subscripts.commas) fixIts.push_back(FixIt::replace(locOf(comma), "]["));
    }
    diagnostics.report(Diag::CommaIndex, locOf(subscripts.commas.front()), {nameOf(parameter->name)}, fixIts);
  }
}

}  // namespace skc::frontend

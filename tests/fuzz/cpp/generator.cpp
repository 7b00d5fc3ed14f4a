// SPDX-License-Identifier: MIT
#include "cpp/generator.hpp"

#include <algorithm>

#include "cpp/body.hpp"
#include "cpp/samples.hpp"

namespace fuzz::cpp {

const std::vector<std::string> constructs = {
    "aliasing",    "auto",    "braces",       "comma",  "constants",  "constrefs",    "defaults",
    "designators", "enums",   "floats",       "inits",  "intrinsics", "jumps",        "loops",
    "matrices",    "methods", "namespaces",   "nested", "narrow",     "narrow_enums", "objects",
    "operators",   "order",   "overloads",    "parts",  "references", "structs",      "switch",
    "templates",   "vectors", "whole_objects"};

namespace {

constexpr int functionCost = 200, functionSize = 120, kernelCost = 3000, kernelSize = 600;

/// `lim` maps any float that has been computed exactly to a multiple of 1/4 below 64.
const char* const prologue =
    "constexpr float lim(float x) { return float(int(x * 4.0f) % 256) * 0.25f; }\n"
    "float2 lim(float2 v) { return float2(lim(v.x), lim(v.y)); }\n"
    "float3 lim(float3 v) { return float3(lim(v.x), lim(v.y), lim(v.z)); }\n"
    "float4 lim(float4 v) { return float4(lim(v.x), lim(v.y), lim(v.z), lim(v.w)); }";

class Generator {
 public:
  Generator(std::uint64_t seed, std::uint64_t number, const std::set<std::string>& without)
      : unit_(seed, number, without), random_(unit_.random), types_(unit_.types) {}

  Program generate() {
    add(makeStatement(prologue), "");
    for (int i = 0; i < 2; ++i) types_.array(pickElement(), random_.between(2, 5));
    const int count = random_.between(16, 32);
    for (int i = 0; i < count; ++i) {
      const std::size_t chosen = random_.below(12);
      if (chosen < 2 && unit_.has("structs")) {
        addStruct();
      } else if (chosen < 3 && unit_.has("enums")) {
        addEnum();
      } else if (chosen < 4 && unit_.has("constants")) {
        addConstant();
      } else {
        addFunction();
      }
    }
    for (int i = 0; i < 3 || (i < 10 && !areAllReached()); ++i) addKernel(i);
    program_.functions += static_cast<int>(std::ranges::count_if(unit_.functions, &Function::isReached));
    return std::move(program_);
  }

 private:
  bool areAllReached() const { return std::ranges::all_of(unit_.functions, &Function::isReached); }

  std::string newSpace() {
    if (!unit_.with("namespaces", 1, 3)) return {};
    return random_.pick(std::vector<std::string>{"n1", "n2", "n1::n3"});
  }

  static std::string qualified(const std::string& space, const std::string& name) {
    return space.empty() ? name : space + "::" + name;
  }

  void add(NodePtr node, const std::string& space) {
    if (!space.empty()) node = makeStatement("namespace " + space + " {\n$\n}", std::move(node));
    program_.root->children.push_back(std::move(node));
  }

  /// A type of members, elements and parameters.
  TypeId pickElement() {
    for (;;) {
      const auto id = static_cast<TypeId>(random_.below(static_cast<std::size_t>(types_.size())));
      const Type& type = types_[id];
      if (type.kind == Type::Kind::Array || types_.leaves(id) > 12) continue;
      if (type.kind == Type::Kind::Vector && !unit_.has("vectors")) continue;
      if (type.kind == Type::Kind::Matrix && (!unit_.has("matrices") || random_.chance(3, 4))) continue;
      if (type.kind != Type::Kind::Struct && type.scalar == Scalar::Float && !unit_.has("floats")) continue;
      if (type.kind == Type::Kind::Scalar && type.scalar < Scalar::Int && type.scalar != Scalar::Bool &&
          !unit_.has("narrow"))
        continue;
      return id;
    }
  }

  TypeId pickScalar() {
    for (;;) {
      const TypeId id = pickElement();
      if (types_.isScalar(id)) return id;
    }
  }

  void addEnum() {
    const std::string space = newSpace(), name = unit_.newName("E");
    Type type{.kind = Type::Kind::Enum, .name = qualified(space, name)};
    type.isScoped = random_.chance(1, 2);
    type.isFixed = type.isScoped || random_.chance(1, 2);
    std::string text = type.isScoped ? "enum class " + name : "enum " + name;
    int most = 1000;
    if (type.isFixed) {
      const bool isSaid = !type.isScoped || random_.chance(2, 3);
      if (isSaid) {
        type.scalar = static_cast<Scalar>(
            unit_.has("narrow") && unit_.has("narrow_enums") ? random_.between(1, 6) : random_.between(5, 6));
        text += " : " + types_.spell(Types::of(type.scalar));
      }
      if (type.scalar == Scalar::Char) most = 127;
      if (type.scalar == Scalar::Uchar) most = 255;
    }
    text += " { ";
    int next = 0;
    const int count = random_.between(2, 5);
    for (int i = 0; i < count; ++i) {
      const std::string enumerator =
          type.isScoped ? std::string(1, static_cast<char>('A' + i)) : name + static_cast<char>('a' + i);
      type.enumerators.push_back(type.isScoped ? type.name + "::" + enumerator
                                               : qualified(space, enumerator));
      text += i == 0 ? enumerator : ", " + enumerator;
      if (random_.chance(1, 3)) {
        next += random_.between(0, most / 8);
        text += " = " + std::to_string(next);
      }
      ++next;
    }
    types_.add(type);
    add(makeStatement(text + " };"), space);
  }

  void addConstant() {
    const std::string space = newSpace(), name = unit_.newName("c");
    const TypeId element = pickElement();
    if (types_[element].kind == Type::Kind::Matrix) return;
    const TypeId type = random_.chance(1, 2) ? types_.array(element, random_.between(2, 5)) : element;
    Body body(unit_, -1, 100, 100);
    body.stayConstant();
    Expr value = types_[type].kind == Type::Kind::Array ? body.braces(type, 0) : body.value(type, 0);
    const std::string prefix = random_.chance(1, 2) && types_.isOfScalars(type) ? "constexpr " : "const ";
    add(makeStatement(prefix + types_.declare(type, name) + " = $;", std::move(value.node)), space);
    unit_.constants.push_back({.name = qualified(space, name), .type = type, .isReferable = false});
  }

  void addStruct() {
    const std::string space = newSpace(), name = unit_.newName("S");
    Type type{.kind = Type::Kind::Struct, .name = qualified(space, name)};
    const bool isTemplate = unit_.with("templates", 1, 4);
    const TypeId parameter = isTemplate ? pickScalar() : -1;
    if (isTemplate) type.name += "<" + types_.spell(parameter) + ">";
    NodePtr members = makeList();
    const int count = random_.between(1, 4);
    for (int i = 0; i < count; ++i) {
      TypeId member = pickElement();
      if (isTemplate && (i == 0 || random_.chance(1, 2))) member = parameter;
      const bool isT = isTemplate && member == parameter;
      if (random_.chance(1, 4)) member = types_.array(member, random_.between(2, 3));
      Field field{.name = std::string("m") + static_cast<char>('a' + i), .type = member};
      std::string text = types_.declare(member, field.name);
      if (isT && types_.isScalar(member)) text = "T " + field.name;
      if (unit_.with("defaults", 1, 2)) {
        field.hasDefault = true;
        Body body(unit_, -1, 100, 100);
        body.stayConstant();
        Expr value = body.initialiser(member, types_[member].kind == Type::Kind::Array ? 1 : 0);
        const bool hasBraces = value.node->text.starts_with("{");
        members->children.push_back(makeStatement(
            text + (hasBraces && random_.chance(1, 2) ? " $;" : " = $;"), std::move(value.node)));
      } else {
        members->children.push_back(makeStatement(text + ";"));
      }
      type.fields.push_back(std::move(field));
    }
    const TypeId id = types_.add(type);
    NodePtr methods = makeList();
    if (unit_.has("methods")) {
      const int methodCount = random_.between(0, 3);
      for (int i = 0; i < methodCount; ++i) methods->children.push_back(method(id));
    }
    const std::string head = isTemplate ? "template <class T>\nstruct " : "struct ";
    add(makeStatement(head + name + " {\n$$};", std::move(members), std::move(methods)), space);
    if (unit_.with("operators", 1, 2)) addOperator(id, space);
  }

  /// Declares parameters in a body, and gives their text; `templated` is spelled T.
  std::string declareParameters(Body& body, Function& function, int count, TypeId first = -1,
                                TypeId templated = -1) {
    std::string text;
    for (int i = 0; i < count; ++i) {
      Parameter parameter{.type = i == 0 && first >= 0 ? first : pickElement()};
      const std::size_t chosen = random_.below(5);
      if (unit_.has("references")) {
        if (chosen < 2) parameter.passing = Passing::Reference;
        if (chosen == 2) parameter.passing = Passing::ConstReference;
      }
      if (parameter.passing == Passing::Value && templated < 0 && !function.isInfix && i > 0 &&
          i == count - 1 && parameter.type != function.owner && random_.chance(1, 3))
        parameter.hasDefault = true;
      const std::string name = "p" + std::to_string(i);
      const std::string spelling = parameter.type == templated ? "T" : types_.spell(parameter.type);
      text += i == 0 ? "" : ", ";
      const bool isConstValue = parameter.passing == Passing::Value && random_.chance(1, 8);
      text += parameter.passing == Passing::ConstReference ? "const " + spelling + "& " + name
              : parameter.passing == Passing::Reference
                  ? spelling + "& " + name
                  : (isConstValue ? "const " : "") + spelling + " " + name;
      if (parameter.hasDefault) text += " = " + types_.simplest(parameter.type);
      if (parameter.hasDefault && types_.simplest(parameter.type).empty()) {
        text.resize(text.size() - 3);
        parameter.hasDefault = false;
      }
      body.declare(
          name, parameter.type,
          parameter.passing == Passing::Reference || (parameter.passing == Passing::Value && !isConstValue));
      function.parameters.push_back(parameter);
    }
    return text;
  }

  void declareConstants(Body& body) {
    for (const Variable& constant : unit_.constants)
      body.declare(constant.name, constant.type, false).isReferable = false;
  }

  void finish(Function function, const Body& body) {
    function.cost = body.cost() + 1;
    function.size = body.size() + 1;
    function.callees = body.callees();
    unit_.functions.push_back(std::move(function));
  }

  NodePtr method(TypeId owner) {
    Function function{.name = unit_.newName("f"), .owner = owner};
    function.isConst = random_.chance(1, 3);
    const bool isInfix = !function.isConst && unit_.with("operators", 1, 4) && unit_.has("objects");
    function.returnsObject = !function.isConst && (isInfix || unit_.with("objects", 1, 3));
    if (!function.returnsObject && random_.chance(2, 3)) function.result = pickElement();
    std::string name = function.name,
                resultText = function.result < 0 ? "void" : types_.spell(function.result);
    if (isInfix) {
      function.isInfix = function.isExact = true;
      function.name = random_.chance(1, 2) ? "+=" : "-=";
      name = "operator" + function.name;
    }
    for (const Function& other : unit_.functions) {
      if (other.owner == owner && other.name == function.name) return makeStatement("");
    }
    if (function.returnsObject) {
      std::string plain = types_.spell(owner);
      plain = plain.substr(0, plain.find('<'));
      const std::size_t colon = plain.rfind(':');
      resultText = (colon == std::string::npos ? plain : plain.substr(colon + 1)) + "&";
    }
    Body body(unit_, function.result, functionCost, functionSize);
    body.declareObject(owner, !function.isConst);
    declareConstants(body);
    if (function.returnsObject) body.mayReturnObject();
    const std::string parameters =
        declareParameters(body, function, isInfix || function.name == "[]" ? 1 : random_.between(0, 2));
    NodePtr statements = body.statements(random_.between(1, 4));
    if (function.returnsObject) function.result = -1;
    const std::string end = function.isConst ? ") const {\n$\n}" : ") {\n$\n}";
    NodePtr node = makeStatement(resultText + " " + name + "(" + parameters + end, std::move(statements));
    finish(std::move(function), body);
    return node;
  }

  void addOperator(TypeId operand, const std::string& space) {
    static const std::vector<std::string> operators = {"+", "-", "*", "/", "%", "&", "|", "^", "<<", ">>"};
    Function function{.name = random_.pick(operators),
                      .result = random_.chance(2, 3) ? operand : pickScalar(),
                      .isInfix = true,
                      .isExact = true};
    Body body(unit_, function.result, functionCost, functionSize);
    declareConstants(body);
    const std::string spelled = types_.spell(operand);
    const bool isReference = unit_.has("references") && random_.chance(1, 2);
    const Parameter first{operand, isReference ? Passing::ConstReference : Passing::Value},
        second{operand, Passing::Value};
    body.declare("p0", operand, !isReference);
    body.declare("p1", operand, true);
    function.parameters = {first, second};
    const std::string head = types_.spell(function.result) + " operator" + function.name + "(" +
                             (isReference ? "const " + spelled + "&" : spelled) + " p0, " + spelled +
                             " p1) {\n$\n}";
    NodePtr node = makeStatement(head, body.statements(random_.between(1, 3)));
    finish(std::move(function), body);
    add(std::move(node), space);
  }

  void addFunction() {
    std::string space = newSpace();
    std::string name = unit_.newName("f");
    Function function;
    if (random_.chance(4, 5)) function.result = pickElement();
    TypeId first = -1, templated = -1;
    std::string head;
    bool hasNumber = false;
    if (unit_.with("templates", 1, 6)) {
      function.isExact = true;
      if (random_.chance(1, 2)) {
        templated = first = pickElement();
        head = "template <class T>\n";
      } else {
        hasNumber = true;
        head = "template <int N>\n";
      }
    } else if (unit_.with("overloads", 1, 5)) {
      std::vector<Function*> others;
      for (Function& other : unit_.functions) {
        if (other.owner >= 0 || other.isInfix || other.parameters.empty() ||
            other.name.find('<') != std::string::npos || templates_.count(other.name) != 0)
          continue;
        if (std::ranges::none_of(other.parameters, &Parameter::hasDefault)) others.push_back(&other);
      }
      if (!others.empty()) {
        Function& other = *random_.pick(others);
        const TypeId type = pickElement();
        const bool isNew = std::ranges::none_of(unit_.functions, [&](const Function& function) {
          return function.name == other.name && function.parameters[0].type == type;
        });
        if (isNew) {
          const std::size_t colon = other.name.rfind("::");
          space = colon == std::string::npos ? "" : other.name.substr(0, colon);
          name = colon == std::string::npos ? other.name : other.name.substr(colon + 2);
          for (Function& function : unit_.functions) function.isExact |= function.name == other.name;
          function.isExact = true;
          first = type;
        }
      }
    }
    function.name = qualified(space, name);
    Body body(unit_, function.result, functionCost, functionSize);
    declareConstants(body);
    if (hasNumber) {
      Variable& number = body.declare("N", Types::of(Scalar::Int), false);
      number.isReferable = false;
    }
    const std::string parameters =
        declareParameters(body, function, random_.between(first >= 0 ? 1 : 0, 4), first, templated);
    if (function.isExact) {
      for (Parameter& parameter : function.parameters) parameter.hasDefault = false;
    }
    if (templated >= 0 || hasNumber) templates_.insert(function.name);
    if (templated >= 0 && random_.chance(1, 2)) function.name += "<" + types_.spell(templated) + ">";
    if (hasNumber) function.name += "<" + std::to_string(random_.between(-2, 9)) + ">";
    const std::string prefix = random_.chance(1, 6) ? "inline " : "";
    head += prefix + (function.result < 0 ? "void" : types_.spell(function.result)) + " " + name + "(" +
            parameters + ") {\n$\n}";
    NodePtr node = makeStatement(head, body.statements(random_.between(1, 6)));
    finish(std::move(function), body);
    add(std::move(node), space);
  }

  void addKernel(int number) {
    Body body(unit_, -1, kernelCost, kernelSize);
    declareConstants(body);
    body.declare("a", Types::of(Scalar::Int), false);
    body.declare("b", Types::of(Scalar::Uint), false);
    body.declare("c", Types::of(Scalar::Float), false);
    body.declare("r0", Types::of(Scalar::Int), true);
    body.declare("r1", Types::of(Scalar::Uint), true);
    body.declare("r2", Types::of(Scalar::Float), true);
    NodePtr statements = body.statements(random_.between(2, 6));
    NodePtr list = std::move(statements->children[0]);
    unit_.reach(body.callees());
    for (std::size_t f = unit_.functions.size(); f-- > 0;) {  // later functions call earlier ones
      if (!unit_.functions[f].isReached && body.addCall(*list, unit_.functions[f]))
        unit_.reach(body.callees());
    }
    body.foldInto(*list);
    const std::string head = "kernel void k" + std::to_string(number) + std::string(kernelParameters);
    add(makeStatement(head + " {\nr0 = 0;\nr1 = 0u;\nr2 = 0.0f;\n$}", std::move(list)), "");
    ++program_.functions;
  }

  Unit unit_;
  Random& random_;
  Types& types_;
  Program program_{.root = makeList()};
  std::set<std::string> templates_;
};

}  // namespace

Program generate(std::uint64_t seed, std::uint64_t number, const std::set<std::string>& without) {
  // A program that lacks some constructs has more of the others, and more of what they do to each other (Groce et al.,
  // "Swarm testing", 2012).
  Random random(seed, ~number);
  std::set<std::string> lacking = without;
  for (const std::string& construct : constructs) {
    if (random.chance(1, 6)) lacking.insert(construct);
  }
  return Generator(seed, number, lacking).generate();
}

}  // namespace fuzz::cpp

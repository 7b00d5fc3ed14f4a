// SPDX-License-Identifier: MIT
#include "cpp/generator.hpp"

#include <algorithm>

#include "cpp/body.hpp"
#include "cpp/kernel_generator.hpp"
#include "cpp/samples.hpp"
#include "cpp/stream_types.hpp"

namespace fuzz::cpp {

const std::vector<std::string> constructs = {"aliasing",       "any_rank",
                                             "arrays",         "auto",
                                             "bindings",       "braces",
                                             "bundles",        "comma",
                                             "conditions",     "constants",
                                             "constrefs",      "defaults",
                                             "designators",    "doubles",
                                             "enums",          "floats",
                                             "functions",      "gathers",
                                             "inits",          "inner_kernels",
                                             "intrinsics",     "jumps",
                                             "likely",         "longs",
                                             "loops",          "lvalue_choices",
                                             "masks",          "matrices",
                                             "methods",        "namespaces",
                                             "narrow",         "narrow_enums",
                                             "narrow_vectors", "nested",
                                             "objects",        "operators",
                                             "order",          "out",
                                             "overloads",      "parts",
                                             "references",     "specs",
                                             "static_members", "structs",
                                             "switch",         "templates",
                                             "temporaries",    "uniforms",
                                             "vector_bits",    "vector_choices",
                                             "vectors",        "whole_objects",
                                             "wide_enums"};

namespace {


/// `lim` maps any float that has been computed exactly to a multiple of 1/4 below 64.
const char* const prologue =
    "constexpr float lim(float x) { return float(int(x * 4.0f) % 256) * 0.25f; }\n"
    "float2 lim(float2 v) { return float2(lim(v.x), lim(v.y)); }\n"
    "float3 lim(float3 v) { return float3(lim(v.x), lim(v.y), lim(v.z)); }\n"
    "float4 lim(float4 v) { return float4(lim(v.x), lim(v.y), lim(v.z), lim(v.w)); }";

/// `near` leaves the bits of a number that all roundings agree in; `some` makes an argument of an integer.
const char* const prologueOfFunctions =
    "float near(float y) { return floor(y * 64.0f + 0.53125f) * 0.015625f; }\n"
    "float2 near(float2 v) { return float2(near(v.x), near(v.y)); }\n"
    "float3 near(float3 v) { return float3(near(v.x), near(v.y), near(v.z)); }\n"
    "float4 near(float4 v) { return float4(near(v.x), near(v.y), near(v.z), near(v.w)); }\n"
    "float some(int k) { return float(k & 31) * 0.25f - 4.0f; }";
const char* const prologueOfDoubleFunctions =
    "double near(double y) { return floor(y * 64.0 + 0.53125) * 0.015625; }\n"
    "double2 near(double2 v) { return double2(near(v.x), near(v.y)); }\n"
    "double3 near(double3 v) { return double3(near(v.x), near(v.y), near(v.z)); }\n"
    "double4 near(double4 v) { return double4(near(v.x), near(v.y), near(v.z), near(v.w)); }\n"
    "double someDouble(int k) { return double(k & 31) * 0.25 - 4.0; }";
const char* const prologueOfAnyRank =
    "template <int N>\n"
    "int at(index<N> p, int d) {\n"
    "if constexpr (N == 1) return p;\n"
    "else return p[d];\n"
    "}";

/// The parameters of templates.
struct Templated {
  TypeId type = -1;  ///< is spelled T
  bool hasLength = false;  ///< the first parameter is an array of N elements
};

/// Doubles become multiples of 2^-12 below 64. The first difference keeps the number in the range of int.
const char* const prologueOfDoubles =
    "double lim(double x) {\n"
    "double part = x - 4096.0 * double(int(x * 0.000244140625));\n"
    "return double(int(part * 4096.0) % 262144) * 0.000244140625;\n"
    "}\n"
    "double2 lim(double2 v) { return double2(lim(v.x), lim(v.y)); }\n"
    "double3 lim(double3 v) { return double3(lim(v.x), lim(v.y), lim(v.z)); }\n"
    "double4 lim(double4 v) { return double4(lim(v.x), lim(v.y), lim(v.z), lim(v.w)); }";

class Generator {
 public:
  Generator(std::uint64_t seed, std::uint64_t number, const std::set<std::string>& without)
      : unit_(seed, number, without), random_(unit_.random), types_(unit_.types) {}

  Program generate() {
    add(makeStatement(prologue), "");
    if (unit_.has("doubles")) add(makeStatement(prologueOfDoubles), "");
    if (unit_.has("functions")) add(makeStatement(prologueOfFunctions), "");
    if (unit_.has("functions") && unit_.has("doubles")) add(makeStatement(prologueOfDoubleFunctions), "");
    if (unit_.hasAnyRank()) add(makeStatement(prologueOfAnyRank), "");
    if (unit_.has("gathers")) {
      streams_.elements.push_back(Types::of(Scalar::Int));
      if (unit_.has("floats")) streams_.elements.push_back(Types::of(Scalar::Float));
      addElement(unit_, streams_);
    }
    for (int i = 0; i < 2; ++i) types_.array(pickElement(), random_.between(2, 5));
    const int count = random_.between(16, 32);
    for (int i = 0; i < count; ++i) {
      const std::size_t chosen = random_.below(14);
      if (chosen < 2 && unit_.has("structs")) {
        addStruct();
      } else if (chosen < 3 && unit_.has("enums")) {
        addEnum();
      } else if (chosen < 4 && unit_.has("constants")) {
        addConstant();
      } else if (chosen < 6 && unit_.has("gathers")) {
        if (unit_.with("inner_kernels", 1, 4)) {
          KernelGenerator(unit_, streams_, program_).addInnerKernel();
        } else if (unit_.has("bundles")) {
          addBundle();
        } else {
          addElement(unit_, streams_);
        }
      } else {
        addFunction();
      }
    }
    KernelGenerator kernels(unit_, streams_, program_);
    for (int i = 0; i < 3 || (i < 10 && !areAllReached()); ++i) kernels.addKernel(i);
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
      if (type.kind == Type::Kind::Matrix && random_.chance(3, 4)) continue;
      if (unit_.mayHave(id)) return id;
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
    type.isWide = type.isScoped && unit_.with("wide_enums", 1, 4);
    std::string text = type.isScoped ? "enum class " + name : "enum " + name;
    int most = 1000;
    if (type.isFixed) {
      const bool isSaid = !type.isScoped || random_.chance(2, 3);
      if (type.isWide) {
        type.scalar = random_.chance(1, 2) ? Scalar::Int : Scalar::Uint;
        text += type.scalar == Scalar::Int ? " : " : " : unsigned ";
        text += random_.chance(1, 2) ? "long" : "long long";
      } else if (isSaid) {
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
    const TypeId parameter = isTemplate ? (random_.chance(1, 2) ? pickScalar() : pickElement()) : -1;
    const int number = isTemplate && random_.chance(1, 3) ? random_.between(2, 3) : 0;
    if (isTemplate)
      type.name += "<" + types_.spell(parameter) + (number != 0 ? ", " + std::to_string(number) + ">" : ">");
    NodePtr members = makeList();
    const int count = random_.between(1, 4);
    for (int i = 0; i < count; ++i) {
      TypeId member = pickElement();
      if (isTemplate && (i == 0 || random_.chance(1, 2))) member = parameter;
      const bool isT = isTemplate && member == parameter;
      const bool hasNumber = number != 0 && (i == 0 || random_.chance(1, 4));
      if (hasNumber || random_.chance(1, 4))
        member = types_.array(member, hasNumber ? number : random_.between(2, 3));
      Field field{.name = std::string("m") + static_cast<char>('a' + i), .type = member};
      std::string text = types_.declare(member, field.name);
      if (isT) text.replace(0, types_.spell(parameter).size(), "T");
      if (hasNumber) text.replace(text.rfind('['), std::string::npos, "[N]");
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
    if (unit_.with("static_members", 1, 4)) addStaticMember(*members, type.name);
    const TypeId id = types_.add(type);
    NodePtr methods = makeList();
    if (unit_.has("methods")) {
      const int methodCount = random_.between(0, 3);
      for (int i = 0; i < methodCount; ++i) methods->children.push_back(method(id));
    }
    const std::string head = !isTemplate   ? "struct "
                             : number == 0 ? "template <class T>\nstruct "
                                           : "template <class T, int N>\nstruct ";
    add(makeStatement(head + name + " {\n$$};", std::move(members), std::move(methods)), space);
    if (unit_.with("operators", 1, 2)) addOperator(id, space);
  }

  void addStaticMember(Node& members, const std::string& owner) {
    const std::string name = unit_.newName("c");
    const TypeId element = pickScalar(),
                 type = random_.chance(1, 3) ? types_.array(element, random_.between(2, 5)) : element;
    Body body(unit_, -1, 100, 100);
    body.stayConstant();
    Expr value = types_[type].kind == Type::Kind::Array ? body.braces(type, 0) : body.value(type, 0);
    members.children.push_back(
        makeStatement("static constexpr " + types_.declare(type, name) + " = $;", std::move(value.node)));
    unit_.constants.push_back({.name = owner + "::" + name, .type = type, .isReferable = false});
  }

  /// A struct of parameters of kernels. The first is a gather, without which it might be a value.
  void addBundle() {
    const std::string space = newSpace(), name = unit_.newName("B");
    const bool isTemplate = unit_.hasAnyRank() && random_.chance(1, 2);
    Type type{.kind = Type::Kind::Bundle, .count = anyRank, .name = qualified(space, name)};
    if (isTemplate) {
      type.name += "<N>";
      type.family = types_.size();  // itself
    }
    NodePtr members = makeList();
    const int count = random_.between(1, 4);
    for (int i = 0; i < count; ++i) {
      const Member kind = i == 0 || random_.chance(1, 3) ? Member::Gather
                          : unit_.with("specs", 1, 4)    ? Member::Spec
                          : random_.chance(1, 3)         ? Member::Bundle
                                                         : Member::Uniform;
      std::optional<Field> field = pickMember(unit_, streams_, kind, isTemplate);
      if (!field) continue;
      field->name = std::string("m") + static_cast<char>('a' + i);
      members->children.push_back(makeStatement(declared(unit_, *field, true) + ";"));
      type.fields.push_back(std::move(*field));
    }
    if (isTemplate) type.family = types_.size();  // arrays and gathers may have been added
    const TypeId id = types_.add(type);
    streams_.bundles.push_back(id);
    NodePtr methods = makeList();
    if (unit_.has("methods")) {
      const int methodCount = random_.between(0, 2);
      for (int i = 0; i < methodCount; ++i) methods->children.push_back(method(id));
    }
    add(makeStatement((isTemplate ? "template <int N>\nstruct " : "struct ") + name + " {\n$$};",
                      std::move(members), std::move(methods)),
        space);
  }

  TypeId pickArray() {
    std::vector<TypeId> arrays;
    for (TypeId id = 0; id < types_.size(); ++id) {
      if (types_[id].kind == Type::Kind::Array && types_.leaves(id) <= 16) arrays.push_back(id);
    }
    return arrays.empty() ? types_.array(Types::of(Scalar::Int), 3) : random_.pick(arrays);
  }

  /// Declares parameters in a body, and gives their text.
  std::string declareParameters(Body& body, Function& function, int count, TypeId first = -1,
                                Templated template_ = {}) {
    std::string text;
    const TypeId templated = template_.type;
    for (int i = 0; i < count; ++i) {
      Parameter parameter{.type = i == 0 && first >= 0 ? first : pickElement()};
      if (!(i == 0 && first >= 0) && !function.isInfix) {
        if (function.isOfAnyRank && (i == 0 || random_.chance(1, 3))) {
          parameter.type = pickStream(unit_, streams_, true);
        } else if (unit_.with("gathers", 1, 5)) {
          parameter.type = pickStream(unit_, streams_, false);
        } else if (unit_.with("arrays", 1, 6)) {
          parameter.type = pickArray();
        }
      }
      if (types_.isOfStreams(parameter.type)) {
        text += (i == 0 ? "" : ", ") + streamParameter(body, function, parameter.type, i);
        continue;
      }
      const bool isArray = types_[parameter.type].kind == Type::Kind::Array;
      const std::size_t chosen = random_.below(5);
      if (unit_.has("references")) {
        if (chosen < 2 && !types_.isIndex(parameter.type)) parameter.passing = Passing::Reference;
        if (chosen == 2) parameter.passing = Passing::ConstReference;
      }
      // Templates deduce nothing from pointers, whose conversions would make overloads ambiguous; methods take references alone.
      if (isArray && (first >= 0 || function.owner >= 0) && parameter.passing == Passing::Value)
        parameter.passing = Passing::ConstReference;
      if (parameter.passing == Passing::Value && !isArray && templated < 0 && !function.isInfix && i > 0 &&
          i == count - 1 && parameter.type != function.owner && random_.chance(1, 3))
        parameter.hasDefault = true;
      const std::string name = "p" + std::to_string(i);
      text += i == 0 ? "" : ", ";
      const bool isConstValue = parameter.passing == Passing::Value && random_.chance(1, isArray ? 2 : 8);
      parameter.takesConst = isConstValue || parameter.passing == Passing::ConstReference;
      const bool isOut =
          parameter.passing == Passing::Reference && !function.isInfix && unit_.with("out", 1, 3);
      std::string declared = isOut ? types_.declare(parameter.type, name)
                             : parameter.passing == Passing::Value
                                 ? types_.declare(parameter.type, name)
                                 : types_.declareReference(parameter.type, name);
      const TypeId element = isArray ? types_[parameter.type].element : parameter.type;
      if (element == templated) declared.replace(0, types_.spell(element).size(), "T");
      if (i == 0 && template_.hasLength) declared.replace(declared.rfind('['), std::string::npos, "[N]");
      if (isOut) text += random_.chance(1, 2) ? "out " : "inout ";
      text += (parameter.passing == Passing::ConstReference || isConstValue ? "const " : "") + declared;
      if (parameter.hasDefault) text += " = " + types_.simplest(parameter.type);
      if (parameter.hasDefault && types_.simplest(parameter.type).empty()) {
        text.resize(text.size() - 3);
        parameter.hasDefault = false;
      }
      const bool isValue = parameter.passing == Passing::Value;
      const bool isMutable = isValue ? !isConstValue && !isArray : parameter.passing == Passing::Reference;
      body.declare(name, parameter.type, isMutable).isPointer = isArray && isValue;
      function.parameters.push_back(parameter);
    }
    return text;
  }

  /// A gather, or a bundle, which may be a constant reference.
  std::string streamParameter(Body& body, Function& function, TypeId type, int number) {
    Field field{.name = "p" + std::to_string(number), .type = type};
    std::string text = declared(unit_, field, true);
    if (types_.isBundle(type) && random_.chance(1, 2))
      text = "const " + types_.declareReference(type, field.name);
    body.declare(field.name, type, false).isReferable = false;
    function.parameters.push_back({.type = type});
    return text;
  }

  NodePtr method(TypeId owner) {
    Function function{.name = unit_.newName("f"), .owner = owner};
    const bool isOfBundle = types_.isBundle(owner);
    function.isConst = isOfBundle || random_.chance(1, 3);
    function.isOfAnyRank = types_.isOfAnyRank(owner);
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
    if (function.isOfAnyRank) body.beOfAnyRank();
    body.declareConstants();
    if (function.returnsObject) body.mayReturnObject();
    const std::string parameters =
        declareParameters(body, function, isInfix || function.name == "[]" ? 1 : random_.between(0, 2));
    NodePtr statements = body.statements(random_.between(1, 4));
    if (function.returnsObject) function.result = -1;
    const std::string end = function.isConst ? ") const {\n$\n}" : ") {\n$\n}";
    NodePtr node = makeStatement(resultText + " " + name + "(" + parameters + end, std::move(statements));
    body.finish(std::move(function));
    return node;
  }

  void addOperator(TypeId operand, const std::string& space) {
    static const std::vector<std::string> operators = {"+", "-", "*", "/", "%", "&", "|", "^", "<<", ">>"};
    Function function{.name = random_.pick(operators),
                      .result = random_.chance(2, 3) ? operand : pickScalar(),
                      .isInfix = true,
                      .isExact = true};
    Body body(unit_, function.result, functionCost, functionSize);
    body.declareConstants();
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
    body.finish(std::move(function));
    add(std::move(node), space);
  }

  /// The type and the value of a template's parameter N; `length` if it is not 0.
  std::pair<TypeId, std::string> templateNumber(int length) {
    if (length != 0) return {Types::of(Scalar::Int), std::to_string(length)};
    std::vector<TypeId> enums;
    for (TypeId id = 0; id < types_.size(); ++id) {
      if (types_[id].kind == Type::Kind::Enum) enums.push_back(id);
    }
    switch (random_.below(5)) {
      case 0: return {Types::of(Scalar::Bool), random_.chance(1, 2) ? "true" : "false"};
      case 1: return {Types::of(Scalar::Uint), std::to_string(random_.between(0, 9)) + "u"};
      case 2:
        if (!enums.empty()) {
          const TypeId type = random_.pick(enums);
          return {type, random_.pick(types_[type].enumerators)};
        }
        break;
      default: break;
    }
    return {Types::of(Scalar::Int), std::to_string(random_.between(-2, 9))};
  }

  void addFunction() {
    std::string space = newSpace();
    std::string name = unit_.newName("f");
    Function function;
    if (random_.chance(4, 5)) function.result = pickElement();
    TypeId first = -1;
    Templated template_;
    std::string head, arguments;
    TypeId numberType = -1;
    if (unit_.hasAnyRank() && random_.chance(1, 6)) {
      function.isOfAnyRank = function.isExact = true;
      head = "template <int N>\n";
    } else if (unit_.with("templates", 1, 6)) {
      function.isExact = true;
      const bool hasType = random_.chance(1, 2), hasNumber = !hasType || random_.chance(1, 4);
      const bool isOfArray = unit_.with("arrays", 1, 3);
      if (hasType) {
        template_.type = first = pickElement();
        if (isOfArray) first = types_.array(template_.type, random_.between(2, 5));
        head = "class T";
        arguments = types_.spell(template_.type);
      } else if (isOfArray) {
        first = pickArray();
      }
      if (hasNumber) {
        template_.hasLength = isOfArray;
        const auto [type, number] = templateNumber(isOfArray ? types_[first].count : 0);
        numberType = type;
        head += (head.empty() ? "" : ", ") + types_.spell(type) + " N";
        arguments += (arguments.empty() ? "" : ", ") + number;
      }
      // Deduced, or given.
      if ((!hasNumber || isOfArray) && random_.chance(1, 2)) arguments.clear();
      head = "template <" + head + ">\n";
    } else if (unit_.with("overloads", 1, 5)) {
      std::vector<Function*> others;
      for (Function& other : unit_.functions) {
        if (other.owner >= 0 || other.isInfix || other.isOfAnyRank || other.parameters.empty() ||
            other.name.find('<') != std::string::npos || templates_.count(other.name) != 0)
          continue;
        const auto isUnsuitable = [&](const Parameter& parameter) {
          const bool isPointer =
              types_[parameter.type].kind == Type::Kind::Array && parameter.passing == Passing::Value;
          return parameter.hasDefault || isPointer || types_.isOfStreams(parameter.type);
        };
        if (std::ranges::none_of(other.parameters, isUnsuitable)) others.push_back(&other);
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
    body.declareConstants();
    if (function.isOfAnyRank) body.beOfAnyRank();
    if (numberType >= 0) body.declare("N", numberType, false).isReferable = false;
    const std::string parameters = declareParameters(
        body, function, random_.between(first >= 0 || function.isOfAnyRank ? 1 : 0, 4), first, template_);
    if (function.isExact) {
      for (Parameter& parameter : function.parameters) parameter.hasDefault = false;
    }
    if (template_.type >= 0 || numberType >= 0) templates_.insert(function.name);
    if (!arguments.empty()) function.name += "<" + arguments + ">";
    const std::string prefix = random_.chance(1, 6) ? "inline " : "";
    head += prefix + (function.result < 0 ? "void" : types_.spell(function.result)) + " " + name + "(" +
            parameters + ") {\n$\n}";
    NodePtr node = makeStatement(head, body.statements(random_.between(1, 6)));
    body.finish(std::move(function));
    add(std::move(node), space);
  }

  Unit unit_;
  StreamTypes streams_;
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

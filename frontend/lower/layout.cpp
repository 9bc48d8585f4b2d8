// Flattens types and lays out memory (SPIR-V specification 2.16.2, Vulkan "Offset and Stride Assignment").
// SPDX-License-Identifier: Apache-2.0
#include "frontend/lower/layout.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace glint::frontend {

using TypeKind = Type::Kind;

Part Layout::scalar(Id id) {
  const Type& type = module_.type(id);
  if (type.kind == TypeKind::Bool) return Part::Bool;
  if (type.kind == TypeKind::Int && type.width == 8) return type.is_signed ? Part::Int8 : Part::Uint8;
  if (type.kind == TypeKind::Int && type.width == 16) return type.is_signed ? Part::Int16 : Part::Uint16;
  if (type.kind == TypeKind::Int && type.width == 32) return type.is_signed ? Part::Int32 : Part::Uint32;
  if (type.kind == TypeKind::Int && type.width == 64) return type.is_signed ? Part::Int64 : Part::Uint64;
  if (type.kind == TypeKind::Float && type.width == 16) return Part::Float16;
  if (type.kind == TypeKind::Float && type.width == 32) return Part::Float32;
  if (type.kind == TypeKind::Float && type.width == 64) return Part::Float64;
  if (type.kind == TypeKind::Image || type.kind == TypeKind::SampledImage) return Part::Uint32;  // its handle
  if (type.kind == TypeKind::AccelerationStructure) return Part::Uint64;  // its address
  if (type.kind == TypeKind::Sampler) return Part::Uint32;                // its part of a handle
  if (type.kind == TypeKind::Pointer && is_address(id))
    return type.storage == spv::StorageClass::Workgroup ? Part::Uint32 : Part::Uint64;
  unsupported_.insert(id);
  return Part::Uint32;
}

bool Layout::is_address(Id id) const {
  const Type& type = module_.type(id);
  if (type.kind != TypeKind::Pointer) return false;
  return type.storage == spv::StorageClass::PhysicalStorageBuffer ||
         type.storage == spv::StorageClass::StorageBuffer || type.storage == spv::StorageClass::Workgroup;
}

bool Layout::is_array_of_blocks(Id pointee) const {
  const Type* type = &module_.type(pointee);
  if (type->kind != TypeKind::Array && type->kind != TypeKind::RuntimeArray) return false;
  while (type->kind == TypeKind::Array || type->kind == TypeKind::RuntimeArray)
    type = &module_.type(type->element);
  return type->kind == TypeKind::Struct && (type->is_block || type->is_buffer_block);
}

const std::vector<Part>& Layout::parts(Id id) {
  if (const auto it = parts_.find(id); it != parts_.end()) return it->second;
  const Type& type = module_.type(id);
  std::vector<Part> result;
  switch (type.kind) {
    case TypeKind::Void:
    case TypeKind::Function:
      break;
    case TypeKind::Vector:
    case TypeKind::Matrix:
    case TypeKind::Array: {
      const std::vector<Part> element = parts(type.element);
      for (uint32_t i = 0; i < type.count; ++i) result.insert(result.end(), element.begin(), element.end());
      break;
    }
    case TypeKind::Struct:
      for (const Type::Member& member : type.members) {
        const std::vector<Part>& part = parts(member.type);
        result.insert(result.end(), part.begin(), part.end());
      }
      break;
    case TypeKind::RuntimeArray:
      break;  // It is never a value; as a block's last member it is reached only by address.
    case TypeKind::Pointer:
      if (is_address(id)) result.push_back(scalar(id));
      break;
    case TypeKind::Bool:
    case TypeKind::Int:
    case TypeKind::Float:
    case TypeKind::Image:
    case TypeKind::Sampler:
    case TypeKind::SampledImage:
    case TypeKind::AccelerationStructure:
    case TypeKind::RayQuery:
    case TypeKind::Other:
      result.push_back(scalar(id));
      break;
  }
  return parts_[id] = std::move(result);
}

Id Layout::member_type(Id id, uint32_t member) const {
  const Type& type = module_.type(id);
  return type.kind == TypeKind::Struct ? type.members.at(member).type : type.element;
}

uint32_t Layout::first_part(Id id, uint32_t member) {
  const Type& type = module_.type(id);
  if (type.kind != TypeKind::Struct) return member * num_parts(type.element);
  uint32_t first = 0;
  for (uint32_t i = 0; i < member; ++i) first += num_parts(type.members[i].type);
  return first;
}

uint32_t Layout::alignment(Id id) {
  uint32_t largest = 1;
  for (Part part : parts(id)) largest = std::max(largest, bytes_of(part));
  return largest;
}

uint32_t Layout::member_offset(Id id, uint32_t member) {
  const Type& type = module_.type(id);
  if (type.members[member].offset) return *type.members[member].offset;
  uint32_t offset = 0;
  for (uint32_t i = 0; i <= member; ++i) {
    const uint32_t align = alignment(type.members[i].type);
    offset = (offset + align - 1) / align * align;
    if (i < member) offset += size(type.members[i].type);
  }
  return offset;
}

MatrixLayout Layout::member_matrix(Id id, uint32_t member, MatrixLayout outer) const {
  const Type& type = module_.type(id);
  if (type.kind != TypeKind::Struct) return outer;
  return {type.members[member].matrix_stride, type.members[member].row_major};
}

uint32_t Layout::element_stride(Id id, MatrixLayout matrix) {
  const Type& type = module_.type(id);
  if (type.kind == TypeKind::Matrix && matrix.stride != 0) return matrix.stride;
  if (type.array_stride != 0) return type.array_stride;
  return size(type.element, matrix);
}

uint32_t Layout::size(Id id, MatrixLayout matrix) {
  const Type& type = module_.type(id);
  switch (type.kind) {
    case TypeKind::Matrix:
      if (matrix.stride != 0)
        return matrix.stride * (matrix.row_major ? module_.type(type.element).count : type.count);
      return type.count * size(type.element);
    case TypeKind::Vector:
    case TypeKind::Array:
      return type.count * element_stride(id, matrix);
    case TypeKind::Struct: {
      uint32_t end = 0;
      for (uint32_t i = 0; i < type.members.size(); ++i)
        end = std::max(end, member_offset(id, i) + size(type.members[i].type, member_matrix(id, i, {})));
      const uint32_t align = alignment(id);
      return (end + align - 1) / align * align;
    }
    default: {
      uint32_t bytes = 0;
      for (Part part : parts(id)) bytes += bytes_of(part);
      return bytes;
    }
  }
}

std::vector<Leaf> Layout::leaves(Id type, MatrixLayout matrix, uint32_t component_stride) {
  std::vector<Leaf> result;
  append_leaves(type, matrix, component_stride, 0, &result);
  return result;
}

void Layout::append_leaves(Id id, MatrixLayout matrix, uint32_t component_stride, uint32_t offset,
                           std::vector<Leaf>* to) {
  const Type& type = module_.type(id);
  switch (type.kind) {
    case TypeKind::Vector: {
      const uint32_t stride = component_stride != 0 ? component_stride : size(type.element);
      for (uint32_t i = 0; i < type.count; ++i) to->push_back({offset + i * stride, scalar(type.element)});
      break;
    }
    case TypeKind::Matrix: {
      const uint32_t stride = element_stride(id, matrix);
      for (uint32_t i = 0; i < type.count; ++i)
        if (matrix.row_major)
          append_leaves(type.element, {}, stride, offset + size(module_.type(type.element).element) * i, to);
        else
          append_leaves(type.element, {}, 0, offset + stride * i, to);
      break;
    }
    case TypeKind::Array: {
      const uint32_t stride = element_stride(id, matrix);
      for (uint32_t i = 0; i < type.count; ++i)
        append_leaves(type.element, matrix, 0, offset + stride * i, to);
      break;
    }
    case TypeKind::Struct:
      for (uint32_t i = 0; i < type.members.size(); ++i)
        append_leaves(type.members[i].type, member_matrix(id, i, {}), 0, offset + member_offset(id, i), to);
      break;
    default:
      if (!parts(id).empty()) to->push_back({offset, scalar(id)});
      break;
  }
}

}  // namespace glint::frontend
